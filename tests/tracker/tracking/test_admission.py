import numpy as np
import pytest

from tracker import Config, Measurements
from tracker.tracking.admission import CALLER_REACH_M, once_per_person

CONFIG = Config(same_person_distance_m=0.45)
HANDS_M = np.array([[2.0, 0.15], [2.0, -0.15], [2.0, 0.0]])


def counted(callers_m, hands_m=HANDS_M, **claimed):
    raised = Measurements.cartesian(hands_m, 0.01 * np.eye(2), **claimed)
    return once_per_person(raised, np.reshape(callers_m, (-1, 2)), CONFIG).values.tolist()


@pytest.mark.parametrize(("callers", "hands"), [(0, 1), (1, 1), (2, 2), (3, 3), (4, 3)])
def test_as_many_hands_count_as_customers_call_beside_them(callers, hands):
    callers_m = [(2.0, 0.1 * number) for number in range(callers)]
    assert counted(callers_m) == HANDS_M[:hands].tolist()


def test_who_calls_out_of_reach_makes_no_room_for_a_second_hand():
    away_m = 2.0 + CALLER_REACH_M + 0.01
    assert counted([(2.0, 0.15), (away_m, -0.15)], HANDS_M[:2]) == HANDS_M[:1].tolist()


def test_hands_of_one_body_count_once_whoever_calls_beside_it():
    assert counted([(2.0, 0.0)] * 2, person=[5, 5, 5]) == HANDS_M[:1].tolist()
