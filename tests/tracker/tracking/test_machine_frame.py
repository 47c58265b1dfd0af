"""The frame as machine code: of which types, and what happens before it is there."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tracker import Config, Measurements, PersonTracker
from tracker.tracking import View
from tracker.tracking.machine_frame import frame_types, machine

ROOT = Path(__file__).parents[3]
HANDS = Measurements.polar([0.0, 0.5, 1.0], [2.0, np.nan, 3.0], 0.03, 0.08)


@pytest.fixture
def needs_numba(machine_code):
    if machine() is None:
        pytest.skip("numba is not installed, or told not to compile")


def fortran(measured):
    return replace(
        measured,
        values=np.asfortranarray(measured.values),
        covariance=np.asfortranarray(measured.covariance),
        sensor_pose=np.asfortranarray(measured.sensor_pose),
    )


ODD = {
    "as they come": lambda: HANDS,
    "nothing": Measurements.none,
    "one": lambda: HANDS[0],
    "broadcast pose covariances": lambda: replace(
        HANDS, sensor_pose_covariance=np.broadcast_to(np.diag([0.1, 0.1, 0.01]), (3, 3, 3))
    ),
    "column by column": lambda: fortran(HANDS),
    "backwards": lambda: HANDS[::-1],
    "every second": lambda: Measurements.concatenate(HANDS, HANDS)[::2],
    "from lists": lambda: Measurements.cartesian(
        [[1, 2], [3, 4]], [[1, 0], [0, 1]], raised=[1, 0]
    ),
    "smaller numbers": lambda: Measurements.polar(
        np.float32([0.1]), np.float32([2]), 0.1, 0.1, hand=np.int8([3]), person=np.uint8([4])
    ),
    "ranges that meet": lambda: Measurements.ranges(
        [3.0, 3.0, 3.0], 0.5, [[0, 0, 0], [5, 0, 0], [2.5, 4, 0]]
    ),
}


@pytest.mark.parametrize("measured", ODD.values(), ids=ODD)
@pytest.mark.parametrize(
    "config",
    [Config(), Config(motion="cv")],
    ids=["two modes", "one mode, biased hands"],
)
@pytest.mark.parametrize("watch", [None, lambda frame: None], ids=["alone", "watched"])
def test_the_frame_is_called_with_exactly_the_types_it_was_compiled_for(
    needs_numba, monkeypatch, measured, config, watch
):
    from numba import typeof

    wanted = list(frame_types())
    tracker, calls = PersonTracker(config, watch=watch), []
    code = machine().code
    (overload,) = code.overloads.values()
    result = overload.signature.return_type

    def spied(*given):
        calls.append([typeof(each) for each in given])
        answer = code(*given)
        calls[-1].append(typeof(answer))
        return answer

    monkeypatch.setattr(machine(), "code", spied)
    view = View(np.array([0, 0, 1]), np.float32(1.2), 8)
    tracker.step(0, HANDS)
    tracker.step(np.int32(10**8), measured(), view=view)
    tracker.lower_hands()
    tracker.step(np.uint64(2 * 10**8), measured(), scan_view=view, camera_looked=False)
    tracker.doubt(np.array([0.1, 0.0, 0.0]), 0.1)
    likeness = np.zeros((len(measured()), len(tracker.people[tracker.people.id > 0]))).T
    tracker.config = Config(motion="imm", confirm_window=9)
    tracker.step(3 * 10**8, measured(), likeness=likeness, camera_looked=1)
    tracker.config = Config(motion="cv", confirm_window=4)
    tracker.reset()
    tracker.step(4 * 10**8, measured())
    assert len(calls) == 5
    for call in calls:
        for found, expected in zip(call, [*wanted, result], strict=True):
            assert found == expected


def test_nothing_is_ever_compiled_again(needs_numba):
    tracker = PersonTracker()
    for number, measured in enumerate(ODD.values()):
        tracker.step(number * 10**8, measured())
    assert len(machine().code.signatures) == 1


#: Tracks a hand, and says what answered.
PROGRAM = """
import logging, sys, threading
{before}
logging.basicConfig(level=logging.INFO, stream=sys.stdout, format="%(levelname)s %(message)s")
import numpy as np
from tracker import Measurements, PersonTracker
from tracker.tracking.machine_frame import machine
tracker = PersonTracker()
hand = Measurements.cartesian([2.0, 1.0], 0.01 * np.eye(2))
def step(number):
    by = "machine code" if machine() is not None and machine().code is not None else "Python"
    print(by, tracker.step(number * 10**8, hand).id.tolist())
step(0)
{between}
step(1)
"""
WAIT = """
for thread in threading.enumerate():
    if thread.name == "compiler":
        thread.join()
"""


def run(before="", between="", **environment):
    ended = subprocess.run(
        [sys.executable, "-c", PROGRAM.format(before=before, between=between)],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        cwd=ROOT,
    )
    assert ended.returncode == 0, ended.stderr
    return ended.stdout.splitlines(), ended.stderr


@pytest.mark.slow
def test_the_first_frames_do_not_wait_for_the_compiler(needs_numba, tmp_path):
    said, _ = run(between=WAIT, NUMBA_CACHE_DIR=str(tmp_path))
    assert [line for line in said if "INFO" not in line] == ["Python [1]", "machine code [1]"]
    said, _ = run(NUMBA_CACHE_DIR=str(tmp_path))
    assert said == ["machine code [1]", "machine code [1]"]


@pytest.mark.slow
def test_where_nothing_can_be_kept_frames_are_machine_code_all_the_same(needs_numba, tmp_path):
    (tmp_path / "cache").touch()
    said, _ = run(between=WAIT, NUMBA_CACHE_DIR=str(tmp_path / "cache"))
    (warning,) = [line for line in said if "WARNING" in line]
    assert "cannot be stored" in warning
    assert "NUMBA_CACHE_DIR" in warning
    assert said[-1] == "machine code [1]"


def test_a_program_that_ends_before_its_compiler_ends_at_once(needs_numba, tmp_path):
    said, errors = run(NUMBA_CACHE_DIR=str(tmp_path))
    assert [line for line in said if "INFO" not in line] == ["Python [1]", "Python [1]"]
    assert errors == ""
    assert not list(tmp_path.rglob("*.nbi"))


#: Ways in which numba may not be there.
BLOCKED = {
    "no module": "sys.modules.update(dict.fromkeys(['numba', 'llvmlite']))",
    "an importer that refuses": """
class Nothing:
    def find_spec(self, name, path=None, target=None):
        if name in ("numba", "llvmlite"):
            raise ModuleNotFoundError(name)
sys.meta_path.insert(0, Nothing())
""",
}


@pytest.mark.parametrize("before", BLOCKED.values(), ids=BLOCKED)
def test_without_numba_everything_runs_as_python(before):
    said, _ = run(before=before)
    assert said[1:] == ["Python [1]", "Python [1]"]
    assert said[0].startswith("WARNING numba cannot be used here")


def test_who_tells_numba_not_to_compile_gets_python():
    said, _ = run(NUMBA_DISABLE_JIT="1")
    assert said[1:] == ["Python [1]", "Python [1]"]
