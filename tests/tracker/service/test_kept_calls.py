"""What a program that was stopped, or killed, knows of calls when it starts again."""

from dataclasses import replace

import pytest

from tracker.containers import Caller, CallState, WaitingList
from tracker.service.kept_calls import KeptCalls

SECOND_NS = 1_000_000_000
ANNA = Caller(
    id=3, state=CallState.WAITING, called_ns=SECOND_NS, state_since_ns=SECOND_NS,
    raised_since_ns=SECOND_NS, last_up_ns=SECOND_NS, is_up=True, xy_m=(1.5, -2.0),
    covariance_m2=(0.1, 0.0, 0.2), seen_ns=SECOND_NS, track_id=8, postponed_ns=0, missing_s=0.0,
)  # fmt: skip


@pytest.fixture
def file(tmp_path):
    return KeptCalls(tmp_path / "calls.json", pytest.fail)


def kept_after(file, *callers):
    for caller in callers:
        file.keep(WaitingList(caller.last_up_ns, (caller,), None))
    (last,) = file.read().callers
    return last


def test_it_is_known_for_how_long_a_hand_was_up(file):
    ups = [replace(ANNA, last_up_ns=SECOND_NS + step * SECOND_NS // 10) for step in range(50)]
    up_s = (kept_after(file, *ups).last_up_ns - ANNA.called_ns) / SECOND_NS
    assert up_s == pytest.approx(4.9, abs=1.0)
    down = replace(ups[-1], is_up=False)
    assert kept_after(file, down).last_up_ns == down.last_up_ns


def test_who_walks_is_kept_where_they_are(file):
    walked = [replace(ANNA, xy_m=(1.5 + step / 10, -2.0)) for step in range(40)]
    assert kept_after(file, *walked).xy_m[0] == pytest.approx(5.4, abs=0.5)


def test_nothing_is_written_while_nothing_changes(file, tmp_path):
    kept_after(file, ANNA)
    before = (tmp_path / "calls.json").stat().st_mtime_ns
    kept_after(file, replace(ANNA, seen_ns=2 * SECOND_NS, covariance_m2=(0.2, 0.0, 0.2)))
    assert (tmp_path / "calls.json").stat().st_mtime_ns == before
