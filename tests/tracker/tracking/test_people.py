import numpy as np
import pytest

from tracker.tracking.modes import Belief
from tracker.tracking.people import People
from tracker.tracking.streaks import Streaks


@pytest.fixture
def people() -> People:
    belief = Belief.begin(np.zeros((3, 4)), np.tile(np.eye(4), (3, 1, 1)), 2, 0.1)
    ids, existence = np.array([2, 0, 1]), np.full(3, 0.5)
    return People.begin(ids, belief, 7, 4, existence)


def test_people_begin_now_without_a_hand_or_a_count(people):
    for stamps_ns in (people.born_ns, people.seen_ns, people.called_ns):
        assert stamps_ns.tolist() == [7, 7, 7]
    assert people.raised_since_ns.tolist() == people.hand.tolist() == [-1, -1, -1]
    for nothing in (people.detections, people.raised, people.recent):
        assert not nothing.any()


def test_what_is_replaced_leaves_everything_else_and_the_original_as_they_were(people):
    changed = people.replace(id=np.array([5, 6, 7]), missing_s=np.ones(3))
    assert changed.id.tolist() == [5, 6, 7]
    assert people.id.tolist() == [2, 0, 1]
    assert changed.missing_s.tolist() == [1, 1, 1]
    assert changed.existence.tolist() == [0.5] * 3
    assert changed.born_ns.tolist() == [7, 7, 7]


def test_streaks_are_replaced_as_one(people):
    streaks = Streaks(np.array([2, 0, 0]), np.array([0, 1, 3]), np.array([True, True, False]))
    changed = people.replace(streaks=streaks)
    assert changed.detected.tolist() == [2, 0, 0]
    assert changed.missed.tolist() == [0, 1, 3]
    assert changed.raised.tolist() == [True, True, False]


def test_a_field_that_people_do_not_have_is_refused(people):
    with pytest.raises(TypeError, match="wisdom"):
        people.replace(wisdom=np.zeros(3))


def test_customers_come_in_the_order_of_their_identities(people):
    assert people.customers().id.tolist() == [1, 2]
    assert people[[2, 0]].append(people[[1]]).id.tolist() == [1, 2, 0]


def test_nobody_outside_can_write_to_people_or_to_their_tracks(people):
    tracks = people.as_tracks(8, None)
    for array in (people.id, people.existence, people.belief.mean, people.recent):
        assert not array.flags.writeable
    for name in ("id", "mean", "covariance", "raised", "age_s", "unseen_s"):
        assert not getattr(tracks, name).flags.writeable
