"""A stopped study goes on where it was, and its files end up the same to the byte."""

import dataclasses
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tracker.errors import ConfigError, RecordingError
from tracker.evaluation.studies.monte_carlo import monte_carlo
from tracker.evaluation.studies.study import study_as_dict
from tracker.evaluation.trials.scenario import SCENARIOS, default_config
from tracker.outputs.folder_lock import FolderLock

ROOT = Path(__file__).parents[4]
PEOPLE = dataclasses.replace(SCENARIOS["people"], duration_s=2.0)
#: Ten units, the last one short, as 170 of people are four.
FILTER, FILTER_TRIALS = SCENARIOS["outliers"], 2300


HOLD_THE_FOLDER = """
import sys, time
from pathlib import Path
from tracker.outputs.folder_lock import FolderLock
lock = FolderLock(Path(sys.argv[1]))
print("held", flush=True)
time.sleep(60)
"""


class Stopped(BaseException):
    """As Ctrl-C."""


def stop_at(share):
    def progress(done):
        if done >= share:
            raise Stopped

    return progress


def files(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Both kinds of studies in one go: what they say, and their files."""
    found = {}
    for name, scenario, trials in (("people", PEOPLE, 170), ("filter", FILTER, FILTER_TRIALS)):
        folder = tmp_path_factory.mktemp(name)
        found[name] = monte_carlo(scenario, trials, seed=3, folder=folder), files(folder)
    return found


@pytest.mark.parametrize(
    ("name", "scenario", "trials"),
    [("people", PEOPLE, 170), ("filter", FILTER, FILTER_TRIALS)],
    ids=["people", "filter"],
)
@pytest.mark.parametrize("lost", [0, 1, 30, 500], ids=lambda lost: f"{lost} bytes lost")
def test_a_stopped_study_ends_up_the_same_to_the_byte(
    whole, tmp_path, name, scenario, trials, lost
):
    study, expected = whole[name]
    with pytest.raises(Stopped):
        monte_carlo(scenario, trials, seed=3, folder=tmp_path, progress=stop_at(0.5))
    rows = tmp_path / "trials.csv"
    rows.write_bytes(rows.read_bytes()[: rows.stat().st_size - lost])
    again = monte_carlo(scenario, trials, seed=3, folder=tmp_path)
    assert files(tmp_path) == expected
    assert study_as_dict(again) == study_as_dict(study)


def test_lost_sums_are_formed_anew_and_rows_stay(whole, tmp_path):
    study, expected = whole["filter"]
    monte_carlo(FILTER, FILTER_TRIALS, seed=3, folder=tmp_path)
    sums = tmp_path / "sums.f64"
    sums.write_bytes(sums.read_bytes()[:5000])
    again = monte_carlo(FILTER, FILTER_TRIALS, seed=3, folder=tmp_path)
    assert files(tmp_path) == expected
    assert np.array_equal(again.information, study.information)


def test_a_finished_study_is_not_run_again(tmp_path):
    class Nobody:
        def submit(self, *words):
            raise AssertionError("nothing is left to do")

    study = monte_carlo(PEOPLE, 3, seed=3, folder=tmp_path)
    again = monte_carlo(PEOPLE, 3, seed=3, folder=tmp_path, executor=Nobody())
    for name, values in study.rows.items():
        assert np.array_equal(values, again.rows[name], equal_nan=True), name


@pytest.mark.parametrize(("scenario", "few", "many"), [(PEOPLE, 60, 170), (FILTER, 300, 2300)])
def test_more_trials_go_on_from_those_that_are_there(whole, tmp_path, scenario, few, many):
    study, _ = whole["people" if scenario is PEOPLE else "filter"]
    monte_carlo(scenario, few, seed=3, folder=tmp_path)
    before = (tmp_path / "trials.csv").read_bytes()
    shares = []
    again = monte_carlo(scenario, many, seed=3, folder=tmp_path, progress=shares.append)
    assert (tmp_path / "trials.csv").read_bytes().startswith(before)
    assert shares[0] > 0.0
    for name, values in study.rows.items():
        np.testing.assert_allclose(again.rows[name], values, rtol=1e-9, err_msg=name)


def test_fewer_trials_than_are_there_are_refused(tmp_path):
    monte_carlo(PEOPLE, 3, folder=tmp_path)
    with pytest.raises(ConfigError, match="holds 3 trials of this study, and 2 were asked for"):
        monte_carlo(PEOPLE, 2, folder=tmp_path)


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"seed": 4}, "seed is 3 in the folder and 4 now"),
        ({"config": default_config(PEOPLE).replace(gate_probability=0.9)}, "config.gate_prob"),
        ({"scenario": dataclasses.replace(PEOPLE, rate_hz=5.0)}, "scenario.rate_hz is 10.0"),
    ],
    ids=["seed", "parameter", "scenario"],
)
def test_another_study_s_folder_is_refused_and_stays_as_it_is(tmp_path, changes, named):
    monte_carlo(PEOPLE, 1, seed=3, folder=tmp_path)
    before = files(tmp_path)
    with pytest.raises(ConfigError, match=rf"holds another study.*{re.escape(named)}"):
        monte_carlo(**{"scenario": PEOPLE, "trials": 1, "seed": 3, "folder": tmp_path, **changes})
    assert files(tmp_path) == before


def test_a_folder_in_which_another_command_writes_is_refused_and_stays_as_it_is(tmp_path):
    def second_study(share):
        before = files(tmp_path)
        with pytest.raises(ConfigError, match=f"{tmp_path.name}: another command is writing"):
            monte_carlo(PEOPLE, 9, seed=3, folder=tmp_path)
        assert files(tmp_path) == before

    monte_carlo(PEOPLE, 3, seed=3, folder=tmp_path, progress=second_study)
    monte_carlo(PEOPLE, 4, seed=3, folder=tmp_path)


def test_a_killed_command_leaves_its_folder_to_the_next(tmp_path):
    writer = subprocess.Popen(
        [sys.executable, "-c", HOLD_THE_FOLDER, tmp_path], stdout=subprocess.PIPE, cwd=ROOT
    )
    with writer:
        assert writer.stdout.readline() == b"held\n"
        with pytest.raises(ConfigError, match="wait until it ends, or choose another folder"):
            FolderLock(tmp_path)
        writer.kill()
    monte_carlo(PEOPLE, 1, folder=tmp_path)


def test_trials_of_nobody_knows_which_study_are_refused(tmp_path):
    (tmp_path / "trials.csv").write_text("trial,gospa_m\n0,0.5\n")
    with pytest.raises(ConfigError, match=r"without a settings\.yaml"):
        monte_carlo(PEOPLE, 1, folder=tmp_path)


@pytest.mark.parametrize("line", ["1,nonsense\n", "7,0.5\n"], ids=["no number", "another trial"])
def test_a_damaged_table_is_named(tmp_path, line):
    monte_carlo(PEOPLE, 1, folder=tmp_path)
    with (tmp_path / "trials.csv").open("a") as file:
        file.write(line)
    with pytest.raises(RecordingError, match=r"trials\.csv.*delete it"):
        monte_carlo(PEOPLE, 2, folder=tmp_path)


def test_a_folder_that_cannot_be_is_named(tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(RecordingError, match="file: cannot be written"):
        monte_carlo(PEOPLE, 1, folder=tmp_path / "file")
