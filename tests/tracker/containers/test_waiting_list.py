from dataclasses import replace

import numpy as np
import pytest

from tracker.containers import Caller, CallState, View, WaitingList
from tracker.errors import RecordingError

ANNA = Caller(
    id=3, state=CallState.BEING_SERVED, called_ns=1, state_since_ns=2, raised_since_ns=3,
    last_up_ns=4, is_up=True, xy_m=(1.5, -2.0), covariance_m2=(0.1, 0.0, 0.2), seen_ns=5,
    track_id=8, postponed_ns=0, missing_s=0.5,
)  # fmt: skip


def test_a_kept_list_comes_back_with_nobody_in_sight():
    kept = WaitingList(10**18, (ANNA,), 3)
    back = WaitingList.from_json(kept.to_json())
    (anna,) = back.callers
    assert (back.stamp_ns, back.selected_id) == (10**18, 3)
    assert (anna.id, anna.state, anna.xy_m) == (3, CallState.BEING_SERVED, (1.5, -2.0))
    assert (anna.track_id, anna.is_up) == (None, False)


INFINITE = '{"stamp_ns": 1, "selected_id": Infinity, "callers": []}'


@pytest.mark.parametrize(
    "text",
    ["", "[]", "{}", '{"stamp_ns": 1, "callers": [{}]}', "null", INFINITE, "[" * 100_000],
    ids=range(7),
)
def test_what_is_no_kept_list_is_refused(text):
    with pytest.raises(RecordingError, match="not a waiting list"):
        WaitingList.from_json(text)


@pytest.mark.parametrize(
    "damage",
    [
        {"id": 0}, {"id": -5}, {"id": 2**63}, {"xy_m": (float("nan"), 0.0)},
        {"covariance_m2": (-1.0, 0.0, 1.0)}, {"called_ns": -1},
    ],
)  # fmt: skip
def test_a_kept_list_with_an_impossible_caller_is_refused(damage):
    text = WaitingList(10**18, (replace(ANNA, **damage),), None).to_json()
    with pytest.raises(RecordingError, match="not a waiting list"):
        WaitingList.from_json(text)


@pytest.mark.parametrize(
    ("xy_m", "expected"),
    [((3.0, 1.0), True), ((1.0, 3.0), True), ((1.0, -1.5), False), ((7.0, 1.0), False)],
)
def test_a_view_covers_what_is_ahead_and_near(xy_m, expected):
    view = View(np.array([1.0, 1.0, np.pi / 4]), np.pi / 2 + 1e-9, 5.0)
    assert view.covers(xy_m) is expected
