"""Who watches a tracker is told what happened inside each frame, and changes nothing."""

import numpy as np
import pytest

from tracker import Config, Measurements
from tracker.tracking.people import ID
from tracker.tracking.trace import NO_TRACE, Trace

CONFIGS = {
    "plain": Config(motion="cv", association="hungarian", outlier_dof=0.0),
    "default": Config(),
    "jointly": Config(association="jpda"),
}


def frames():
    rng = np.random.default_rng(4)
    for _ in range(30):
        bearing, range_m = 0.1 * rng.normal(size=2), 3.0 + 0.1 * rng.normal(size=2)
        yield Measurements.polar(
            bearing + np.array([0.0, 1.0]), range_m, 0.05, 0.08, raised=[True, False]
        )


@pytest.mark.parametrize("config", CONFIGS.values(), ids=CONFIGS)
def test_watching_changes_no_track(tracker_of, config):
    told = []
    watched, alone = tracker_of(config, watch=told.append), tracker_of(config)
    for number, measured in enumerate(frames()):
        seen = watched.step(number * 10**8, measured)
        tracks = alone.step(number * 10**8, measured)
        for name, value in tracks.__dict__.items():
            np.testing.assert_array_equal(getattr(seen, name), value, name)
    assert [frame.stamp_ns for frame in told] == [number * 10**8 for number in range(30)]


def test_a_watcher_is_told_of_the_people_before_the_frame(tracker_of):
    told = []
    tracker = tracker_of(watch=told.append)
    before = []
    for number, measured in enumerate(frames()):
        before.append(tracker.people.id.tolist())
        tracker.step(number * 10**8, measured)
    assert [frame.people.counts[ID].tolist() for frame in told] == before


def test_a_page_says_whose_each_measurement_may_be_and_whose_it_is(tracker_of):
    told = []
    tracker = tracker_of(CONFIGS["plain"], watch=told.append)
    hands = Measurements.cartesian([[2.0, 0.0], [2.0, 2.0]], 0.01 * np.eye(2))
    for number in range(3):
        tracker.step(number * 10**8, hands[::-1] if number == 2 else hands)
    trace = told[-1].trace
    assert trace.rounds.tolist() == [1]
    assert trace.round_of.tolist() == [0, 0]
    assert trace.pairs[0, : trace.counts[0]].tolist() == [[0, 1, 1], [1, 0, 1]]


def test_where_nobody_watches_there_is_no_room():
    assert all(array.size == 0 for array in NO_TRACE)


def test_there_is_room_for_whatever_one_frame_can_do():
    trace = Trace.room(3, 2, 4)
    assert trace.round_of.tolist() == [-1, -1, -1]
    assert trace.pairs.shape == (3, 12, 3)
    assert trace.log_likelihood.shape == (3, 12, 3)
    assert trace.belief.shape == (3, 2, 4, 21)
    assert trace.people.shape == (3, 4, 2)
