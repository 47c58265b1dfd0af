"""Who is let in, under which identity, and who is let go."""

import numpy as np
import pytest

from tracker import Config, Measurements
from tracker.tracking.life_cycle import count_detections
from tracker.tracking.motion import modes_of
from tracker.tracking.observation import Observed
from tracker.tracking.people import People
from tracker.tracking.renewal import renew

CONFIG = Config()
NOISE = 0.01 * np.eye(2)
NOTHING = np.zeros((0, 2))


def claims(places, raised=True, hand=-1):
    return Measurements.cartesian(np.reshape(places, (-1, 2)), NOISE, raised=raised, hand=hand)


def observed(people=None, raised=NOTHING, others=NOTHING, is_called=(), is_seen=(), hand=-1):
    people = people or People.nobody(CONFIG.confirm_window, modes_of(CONFIG))
    called, seen = np.array(is_called, dtype=bool), np.array(is_seen, dtype=bool)
    return Observed(people, called, seen, claims(raised), claims(others, False, hand))


def room(*others):
    """Bystanders at these places."""
    people, _ = renew(observed(others=others), 1, 0, CONFIG)
    return people


def test_raised_hands_begin_customers_under_the_next_identities():
    people, next_id = renew(observed(raised=[(1.0, 0.0), (5.0, 0.0)]), 7, 0, CONFIG)
    assert people.id.tolist() == [7, 8]
    assert people.detections.tolist() == [1, 1]
    assert next_id == 9


def test_a_cluster_of_the_scan_begins_a_bystander_and_spends_no_identity():
    people, next_id = renew(observed(others=[(1.0, 0.0)]), 7, 0, CONFIG)
    assert people.id.tolist() == [0]
    assert next_id == 7


def test_a_lowered_hand_alone_is_nobody():
    people, _ = renew(observed(others=[(1.0, 0.0)], hand=3), 1, 0, CONFIG)
    assert len(people) == 0


def test_a_bystander_who_is_called_gets_the_next_identity():
    called, seen = np.array([False, True]), np.array([True, True])
    people = count_detections(room((1.0, 0.0), (5.0, 0.0)), called, seen, 10**8, CONFIG)
    seen = observed(people, is_called=called, is_seen=seen)
    people, next_id = renew(seen, 4, 10**8, CONFIG)
    assert people.id.tolist() == [0, 4]
    assert next_id == 5


@pytest.mark.parametrize(("reaches", "count"), [(0.5, 1), (1.5, 2)])
def test_a_hand_within_a_persons_reach_is_their_second_one(reaches, count):
    people, _ = renew(observed(raised=[(1.0, 0.0)]), 1, 0, CONFIG)
    apart_m = reaches * CONFIG.same_person_distance_m
    seen = observed(people, raised=[(1.0 + apart_m, 0.0)], is_called=[True], is_seen=[True])
    people, _ = renew(seen, 2, 10**8, CONFIG)
    assert len(people) == count


def test_whoever_is_not_there_any_more_is_let_go():
    people = room((1.0, 0.0))
    gone = people.replace(missing_s=np.array([2.0 * CONFIG.delete_after_s]))
    people, _ = renew(observed(gone, is_called=[False], is_seen=[False]), 1, 10**8, CONFIG)
    assert len(people) == 0
