"""What the outside sees of everybody."""

import numpy as np
import pytest

from tracker import Measurements
from tracker.tracking.life_cycle.renewal import Frame
from tracker.tracking.people import AGE_S, RAISED, UNSEEN_S
from tracker.tracking.result import customers_of, tracks_of


@pytest.fixture
def frame_of(people_of, merged):
    """A frame with these identities; the third person has a hand up."""

    def frame(*ids):
        count = len(ids)
        places = np.pad(np.arange(count * 2.0).reshape(-1, 2), ((0, 0), (0, 2)))
        people = people_of(places, np.eye(4), ids=ids)
        people.flags[RAISED, 2:3] = True
        people.spans[AGE_S], people.spans[UNSEEN_S] = 3.0, 1.0
        mean, covariance = merged(people)
        return Frame(people, mean[None], covariance[None], 9, -9, 2)

    return frame


@pytest.mark.parametrize(
    ("ids", "rows"),
    [
        ((), None),
        ((1, 2, 5), None),
        ((2, 1, 5), [1, 0, 2]),
        ((-1, 4, -2, 3), [3, 1]),
        ((-1, -2), []),
    ],
)
def test_customers_come_in_the_order_of_their_identities(frame_of, ids, rows):
    found = customers_of(frame_of(*ids))
    assert (found if rows is None else found.tolist()) == rows


def test_tracks_are_the_people_of_these_rows(frame_of):
    frame = frame_of(-1, 4, 3)
    tracks = tracks_of(frame, 4, np.array([2, 1]))
    assert tracks.stamp_ns == 4
    assert tracks.id.tolist() == [3, 4]
    assert tracks.mean[:, :2].tolist() == [[4.0, 5.0], [2.0, 3.0]]
    assert tracks.raised.tolist() == [True, False]
    assert tracks.age_s.tolist() == [3.0, 3.0]
    assert tracks.unseen_s.tolist() == [1.0, 1.0]
    assert tracks.selected_id is None
    assert tracks.refused == 2


def test_without_rows_everybody_is_a_track(frame_of):
    assert tracks_of(frame_of(-1, 4, 3), 0, None).id.tolist() == [-1, 4, 3]


def test_nobody_outside_can_write_to_tracks(frame_of):
    for rows in (None, np.array([0])):
        tracks = tracks_of(frame_of(1, 2), 8, rows)
        for name, each in tracks.__dict__.items():
            assert not isinstance(each, np.ndarray) or not each.flags.writeable, name


@pytest.mark.parametrize("change", ["lower_hands", "doubt", "step"])
def test_tracks_that_were_handed_out_stay_as_they_were(tracker_of, change):
    tracker, hand = tracker_of(), Measurements.cartesian([2.0, 1.0], 0.01 * np.eye(2))
    for number in range(5):
        tracks = tracker.step(number * 10**8, hand)
    given = tracks, tracker.people
    before = [{name: np.copy(value) for name, value in each.__dict__.items()} for each in given]
    changes = {
        "lower_hands": tracker.lower_hands,
        "doubt": lambda: tracker.doubt(np.array([0.1, 0.2, 0.1]), 0.5),
        "step": lambda: tracker.step(10**9, Measurements.none()),
    }
    changes[change]()
    for now, then in zip(given, before, strict=True):
        for name, value in then.items():
            np.testing.assert_array_equal(getattr(now, name), value, name)
