"""Admission, identity assignment and removal of people."""

import numpy as np
import pytest

from tracker import Config, Measurements
from tracker.tracking.association.found import nothing_found
from tracker.tracking.instant import Instant
from tracker.tracking.life_cycle.renewal import renew
from tracker.tracking.people import AGE_S, DETECTIONS, HAND, ID, MISSING_S, TAG, UNSEEN_S, room_for
from tracker.tracking.prediction.motion import modes_of
from tracker.tracking.sensing.claims import claims_of
from tracker.tracking.sensing.view import view_numbers
from tracker.tracking.settings import settings_of

CONFIG = Config()
NOISE = 0.01 * np.eye(2)
EVERYWHERE = view_numbers(None)


def at(places, raised=True, **claimed):
    return Measurements.cartesian(np.reshape(places, (-1, 2)), NOISE, raised=raised, **claimed)


def renewed(measured, people=None, owner=None, next_id=1, stamp_ns=0, next_bystander=-1):
    """The frame after these measurements; `owner` says whose they are."""
    if people is None:
        people = room_for(modes_of(CONFIG), 0, CONFIG.confirm_window)
    known = people.weight.shape[1]
    found = nothing_found(known, len(measured), np.arange(len(measured)))
    for row, person in enumerate(owner or ()):
        found.owner[row], found.certainty[person] = person, 1.0
        found.is_called[person] |= measured.raised[row]
        found.hand[person] = measured.hand[row]
    instant = Instant(
        *(stamp_ns, 0.1, next_id, next_bystander, EVERYWHERE, EVERYWHERE, False, True)
    )
    return renew(people, claims_of(measured), found, instant, settings_of(CONFIG))


def bystanders(*places):
    return renewed(at(places, raised=False)).people


def test_raised_hands_begin_customers_under_the_next_identities():
    frame = renewed(at([(1.0, 0.0), (5.0, 0.0)]), next_id=7)
    assert frame.people.counts[ID].tolist() == [7, 8]
    assert frame.people.counts[DETECTIONS].tolist() == [1, 1]
    assert frame.next_id == 9


def test_a_cluster_of_the_scan_begins_a_bystander_and_spends_no_customer_s_identity():
    frame = renewed(at([(1.0, 0.0), (5.0, 0.0)], raised=False), next_id=7, next_bystander=-3)
    assert frame.people.counts[ID].tolist() == [-3, -4]
    assert (frame.next_id, frame.next_bystander) == (7, -5)


def test_a_lowered_hand_alone_is_nobody():
    frame = renewed(at([(1.0, 0.0)], raised=False, hand=3))
    assert frame.people.weight.shape[1] == 0
    assert frame.refused == 0


def test_a_range_alone_shows_nobody_new_and_is_counted():
    ranges = Measurements.ranges([2.0, 3.0], 0.1, raised=[True, False])
    frame = renewed(ranges)
    assert frame.people.weight.shape[1] == 0
    assert frame.refused == 2
    assert frame.next_id == 1


def test_a_bystander_who_is_called_gets_the_next_identity():
    people = bystanders((1.0, 0.0), (5.0, 0.0))
    both = Measurements.concatenate(at([1.0, 0.0], raised=False), at([5.0, 0.0], hand=6))
    frame = renewed(both, people, owner=[0, 1], next_id=4, stamp_ns=10**8)
    assert frame.people.counts[ID].tolist() == [-1, 4]
    assert frame.people.counts[HAND].tolist() == [-1, 6]
    assert frame.next_id == 5


def test_a_hint_of_identity_is_remembered():
    people = bystanders((1.0, 0.0))
    assert people.counts[TAG].tolist() == [-1]
    frame = renewed(at([1.0, 0.0], identity=9), people, owner=[0], stamp_ns=10**8)
    assert frame.people.counts[TAG].tolist() == [9]


@pytest.mark.parametrize(("reaches", "count"), [(0.5, 1), (1.5, 2)])
def test_a_hand_within_a_persons_reach_is_their_second_one(reaches, count):
    people = renewed(at([1.0, 0.0])).people
    apart_m = reaches * CONFIG.same_person_distance_m
    hands = at([(1.0, 0.0), (1.0 + apart_m, 0.0)])
    frame = renewed(hands, people, owner=[0], next_id=2, stamp_ns=10**8)
    assert frame.people.weight.shape[1] == count


def test_whoever_is_not_there_any_more_is_let_go():
    people = bystanders((1.0, 0.0), (5.0, 0.0))
    people.spans[MISSING_S, 0] = 2.0 * CONFIG.delete_after_s
    frame = renewed(Measurements.none(), people, stamp_ns=10**8)
    assert frame.people.counts[ID].tolist() == [-2]
    assert frame.mean[0, :, 0].tolist() == [5.0]


def test_the_frame_s_gaussians_are_those_of_its_people(merged):
    people = bystanders((1.0, 0.0), (5.0, 0.0))
    people.mean[1] += 0.1
    frame = renewed(at([9.0, 0.0]), people, stamp_ns=10**8)
    assert frame.mean.shape == (1, 3, 4)
    for found, expected in zip((frame.mean, frame.covariance), merged(frame.people), strict=True):
        np.testing.assert_array_equal(found[0], expected)


def test_everybody_s_age_and_silence_are_counted_in_seconds():
    people = bystanders((1.0, 0.0), (5.0, 0.0))
    frame = renewed(at([1.0, 0.0], raised=False), people, owner=[0], stamp_ns=25 * 10**7)
    assert frame.people.spans[AGE_S].tolist() == [0.25, 0.25]
    assert frame.people.spans[UNSEEN_S].tolist() == [0.0, 0.25]
