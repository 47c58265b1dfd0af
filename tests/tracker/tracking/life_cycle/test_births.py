"""How a track begins."""

import numpy as np
import pytest

from tracker import Config, Measurements
from tracker.tracking.association.found import nothing_found
from tracker.tracking.life_cycle.births import begin_person, is_apart
from tracker.tracking.life_cycle.life_cycle import BIRTH_EXISTENCE
from tracker.tracking.people import (
    BORN_NS,
    CALLED_NS,
    DETECTED,
    DETECTIONS,
    EXISTENCE,
    HAND,
    ID,
    MISSED,
    MISSING_S,
    RAISED_SINCE_NS,
    SEEN_NS,
    TAG,
    room_for,
)
from tracker.tracking.sensing.claims import claims_of
from tracker.tracking.settings import settings_of

CONFIG = Config(initial_speed_std_mps=0.7, stand_speed_std_mps=0.1)
PLACE = (1.0, 2.0, 0.04, 0.01, 0.09)


@pytest.fixture
def newcomer():
    """The second of two rows in which anything stood."""
    room = room_for(2, 2, 4)
    for array in room:
        array[:] = 77
    measured = Measurements.cartesian([9.0, 9.0], np.eye(2), hand=3, identity=8)
    claims, settings = claims_of(measured), settings_of(CONFIG)
    begin_person(room, 1, -5, PLACE, claims, 0, 12, settings)
    return room


def test_a_newcomer_stands_at_the_place_and_walks_or_stands(newcomer):
    assert newcomer.weight[:, 1].tolist() == [0.5, 0.5]
    assert newcomer.mean[:, 1].tolist() == [[1.0, 2.0, 0.0, 0.0]] * 2
    for mode, speed_std_mps in enumerate((0.7, 0.1)):
        expected = np.diag([0.04, 0.09, speed_std_mps**2, speed_std_mps**2])
        expected[0, 1] = expected[1, 0] = 0.01
        np.testing.assert_array_equal(newcomer.covariance[mode, 1], expected)


def test_people_begin_now_without_a_hand_or_a_count(newcomer):
    counts = newcomer.counts[:, 1]
    assert counts[[BORN_NS, SEEN_NS, CALLED_NS]].tolist() == [12, 12, 12]
    assert counts[[ID, TAG, HAND, RAISED_SINCE_NS]].tolist() == [-5, 8, 3, -1]
    assert counts[[DETECTED, MISSED, DETECTIONS]].tolist() == [0, 0, 0]
    assert newcomer.spans[[EXISTENCE, MISSING_S], 1].tolist() == [BIRTH_EXISTENCE, 0.0]
    assert not newcomer.flags[:, 1].any()
    assert not newcomer.recent[1].any()


def test_nobody_else_s_row_is_touched(newcomer):
    assert (newcomer.counts[:, 0] == 77).all()
    assert (newcomer.mean[:, 0] == 77.0).all()


@pytest.mark.parametrize(
    ("is_raised", "x_m", "expected"),
    [
        (True, 0.3, False),  # the first has called
        (True, 2.3, True),  # the second was seen alone
        (False, 2.3, False),
        (False, 4.3, True),  # the third was not even seen
        (False, 0.6, True),  # too far from anybody
    ],
)
def test_who_has_just_been_seen_or_has_called_leaves_no_room_beside(is_raised, x_m, expected):
    found = nothing_found(3, 0, np.zeros(0, dtype=int))
    found.is_called[:], found.certainty[:] = [True, False, False], [0.9, 0.1, 0.0]
    mean = np.array([[[0.0, 0, 0, 0], [2.0, 0, 0, 0], [4.0, 0, 0, 0]]])
    assert is_apart(found, mean, is_raised, x_m, 0.0, 0.45) == expected
