"""Which measurements come in, and in which rounds?"""

from dataclasses import replace
from itertools import chain

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker import Config, Measurements
from tracker.containers import SensorKind
from tracker.tracking.association.admission import CALLER_REACH_M, plan_rounds
from tracker.tracking.people import RAISED
from tracker.tracking.sensing.claims import claims_of
from tracker.tracking.settings import settings_of

CONFIG = Config(same_person_distance_m=0.45)
HANDS_M = np.array([[2.0, 0.15], [2.0, -0.15], [2.0, 0.0]])


@pytest.fixture(scope="session")
def rounds_of(people_of):
    """Rows of each round, raised ones first, and how many of them are raised."""

    def rounds(measured, callers_m=()):
        places = np.pad(np.reshape(callers_m, (-1, 2)), ((0, 0), (0, 2)))
        people = people_of(places, np.eye(4))
        people.flags[RAISED] = True
        claims = claims_of(measured)
        found = plan_rounds(people, people.mean, claims, settings_of(CONFIG))
        edges = zip(found.begins[:-1], found.begins[1:], strict=True)
        return [found.rows[begin:end].tolist() for begin, end in edges], found.raised

    return rounds


@pytest.fixture
def counted(rounds_of):
    """Rows of the hands that count, given where customers call."""

    def rows(callers_m, hands_m=HANDS_M, **claimed):
        hands = Measurements.cartesian(hands_m, 0.01 * np.eye(2), **claimed)
        return [row for rows in rounds_of(hands, callers_m)[0] for row in rows]

    return rows


@pytest.mark.parametrize(("callers", "hands"), [(0, 1), (1, 1), (2, 2), (3, 3), (4, 3)])
def test_as_many_hands_count_as_customers_call_beside_them(counted, callers, hands):
    callers_m = [(2.0, 0.1 * number) for number in range(callers)]
    assert counted(callers_m) == list(range(hands))


def test_who_calls_out_of_reach_makes_no_room_for_a_second_hand(counted):
    away_m = 2.0 + CALLER_REACH_M + 0.01
    assert counted([(2.0, 0.15), (away_m, -0.15)], HANDS_M[:2]) == [0]


def test_what_one_sensor_says_of_one_body_again_has_a_round_of_its_own(rounds_of):
    hands = Measurements.cartesian(HANDS_M, 0.01 * np.eye(2), person=[5, 5, -1])
    apart = Measurements.cartesian([[9.0, 0.0], [9.0, 5.0]], 0.01 * np.eye(2), person=[6, 6])
    assert rounds_of(hands[:2])[0] == [[0], [1]]
    measured = Measurements.concatenate(apart, hands[:2])
    assert rounds_of(measured)[0] == [[0, 2], [1, 3]]


def test_who_measures_from_elsewhere_may_show_the_same_hand(rounds_of):
    here = Measurements.polar(0.0, 2.0, 0.02, 0.1)
    there = Measurements.polar(np.pi, 2.0, 0.02, 0.1, (4.0, 0.0, 0.0))
    assert rounds_of(Measurements.concatenate(here, there))[0] == [[0], [1]]


@pytest.mark.parametrize("raised", [True, False])
def test_every_kind_of_sensor_comes_in_once(rounds_of, raised):
    measured = Measurements.concatenate(
        Measurements.polar([0.0, 0.5, np.nan], [2.0, np.nan, 2.0], 0.02, 0.1, raised=raised),
        Measurements.cartesian([5.0, 5.0], np.eye(2), raised=raised),
    )
    assert set(measured.kind.tolist()) == set(SensorKind)
    assert sorted(chain(*rounds_of(measured)[0])) == [0, 1, 2, 3]


def test_hands_far_apart_all_count(counted):
    assert counted([], [[2.0, 0.0], [2.0, 0.5], [2.0, 1.0]]) == [0, 1, 2]


def test_a_range_alone_has_no_place_and_keeps_nobody_out(rounds_of):
    hands = Measurements.concatenate(
        Measurements.ranges([2.0, 2.0], 0.1), Measurements.polar(0.0, 2.0, 0.02, 0.1)
    )
    assert rounds_of(hands)[0] == [[0, 1], [2]]


def test_raised_hands_come_before_everything_else(rounds_of):
    measured = Measurements.cartesian(
        [[1.0, 0.0], [3.0, 0.0], [5.0, 0.0]], np.eye(2), raised=[False, True, False]
    )
    assert rounds_of(measured) == ([[1], [0, 2]], 1)


def test_a_camera_whose_hands_have_a_range_now_and_then_is_one_sensor(rounds_of):
    measured = Measurements.polar([0.0, 0.5, 1.0], [np.nan, 2.0, np.nan], 0.02, 0.1)
    ((rows,), raised) = rounds_of(measured)
    assert sorted(rows) == [0, 1, 2]
    assert raised == 1
    kinds = measured.kind[rows].tolist()
    assert kinds == sorted(kinds)  # those of one kind side by side


def test_who_measures_from_elsewhere_or_less_surely_is_another_sensor(rounds_of):
    measured = Measurements.polar(
        [0.0, 0.0, -2.0], 2.0, 0.02, 0.1, [[0.0, 0, 0], [0.0, 0, 1], [0.0, 0, 0]]
    )
    doubt = np.zeros((3, 3, 3))
    doubt[2, 0, 0] = 0.01
    assert rounds_of(measured)[0] == [[0, 2], [1]]
    assert rounds_of(replace(measured, sensor_pose_covariance=doubt))[0] == [[0], [1], [2]]


@given(
    kinds=st.lists(st.integers(0, 3), max_size=12),
    raised=st.lists(st.booleans(), min_size=12, max_size=12),
    sensor=st.lists(st.integers(0, 2), min_size=12, max_size=12),
)
def test_every_row_that_is_no_second_hand_is_in_one_round(rounds_of, kinds, raised, sensor):
    parts = [Measurements.none()]
    for row, kind in enumerate(kinds):
        bearing_rad, range_m = [(row / 2, 3.0), (row / 2, np.nan), (np.nan, 3.0), (0, 0)][kind]
        pose = (20.0 * sensor[row], 0.0, 0.0)
        one = Measurements.polar(bearing_rad, range_m, 0.01, 0.01, pose, raised=raised[row])
        if kind == 3:
            one = Measurements.cartesian([5.0 * row, -9], np.eye(2), raised=raised[row])
        parts.append(one)
    measured = Measurements.concatenate(*parts)
    rounds, raised_rounds = rounds_of(measured)
    assert sorted(chain(*rounds)) == list(range(len(measured)))
    for number, rows in enumerate(rounds):
        assert (measured.raised[rows] == (number < raised_rounds)).all()
        assert len({tuple(pose) for pose in measured.sensor_pose[rows]}) == 1
