"""Measurements that no tracker can use: refused with their row, or left out on request."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from tracker.containers import Measurements, SensorKind
from tracker.containers.measurement_check import are_semidefinite, usable_rows
from tracker.errors import MeasurementError, ShapeError

NAN, INF = math.nan, math.inf
ANY = st.floats(allow_nan=True, allow_infinity=True)
GOOD = Measurements.polar([0.1, 0.2, 0.3], [1.0, NAN, 3.0], 0.02, 0.1)


def polar(**changes):
    """Three rows, of which the middle one is changed."""
    columns = {
        "bearing_rad": np.array([0.1, 0.2, 0.3]),
        "range_m": np.array([1.0, 2.0, 3.0]),
        "bearing_std_rad": np.full(3, 0.02),
        "range_std_m": np.full(3, 0.1),
        "sensor_pose": np.tile([1.0, 2.0, 0.5], (3, 1)),
        "sensor_pose_covariance": np.zeros((3, 3, 3)),
        "bias_covariance": np.zeros((3, 2, 2)),
    }
    refuse = changes.pop("refuse", "raise")
    for name, value in changes.items():
        columns[name][1] = value
    return Measurements.polar(**columns, refuse=refuse)


BAD_ROWS = {
    "nothing measured": ({"bearing_rad": NAN, "range_m": NAN}, "neither bearing nor range"),
    "infinite bearing": ({"bearing_rad": INF}, "the bearing inf rad"),
    "absurd bearing": ({"bearing_rad": -2e9}, "the bearing -2000000000.0 rad"),
    "infinite range": ({"range_m": INF}, "the range inf m"),
    "absurd range": ({"range_m": 1.1e9}, "the range 1100000000.0 m"),
    "negative range": ({"range_m": -0.1}, "the range -0.1 m"),
    "no bearing noise": ({"bearing_std_rad": 0.0}, "bearing's standard deviation 0 rad"),
    "negative bearing noise": ({"bearing_std_rad": -0.5}, "bearing's standard deviation -0.5"),
    "unknown bearing noise": ({"bearing_std_rad": NAN}, "bearing's standard deviation nan"),
    "a full turn of noise": ({"bearing_std_rad": 6.3}, "less than 6.28319 rad"),
    "no range noise": ({"range_std_m": 0.0}, "range's standard deviation 0 m"),
    "negative range noise": ({"range_std_m": -1.0}, "range's standard deviation -1 m"),
    "unknown range noise": ({"range_std_m": NAN}, "range's standard deviation nan"),
    "infinite range noise": ({"range_std_m": INF}, "range's standard deviation inf"),
    "noise whose square overflows": ({"range_std_m": 1e200}, "range's standard deviation inf"),
    "noise whose square vanishes": ({"range_std_m": 1e-200}, "range's standard deviation 0 m"),
    "bearing alone without noise": (
        {"range_m": NAN, "bearing_std_rad": 0.0}, "bearing's standard deviation 0",
    ),
    "range alone without noise": (
        {"bearing_rad": NAN, "range_std_m": -1.0}, "range's standard deviation -1",
    ),
    "range alone negative": ({"bearing_rad": NAN, "range_m": -1.0}, "the range -1.0"),
    "sensor nowhere": ({"sensor_pose": (NAN, 0.0, 0.0)}, "sensor_pose [nan, 0.0, 0.0]"),
    "sensor absurdly far": ({"sensor_pose": (0.0, -1e10, 0.0)}, "sensor_pose [0.0, -10000"),
    "sensor turned to infinity": ({"sensor_pose": (0.0, 0.0, INF)}, "sensor_pose [0.0, 0.0, inf]"),
    "doubt that is negative": ({"sensor_pose_covariance": -np.eye(3)}, "positive semidefinite"),
    "doubt that is lopsided": (
        {"sensor_pose_covariance": np.eye(3) + np.eye(3, k=1)}, "sensor_pose_covariance [[1.0, 1",
    ),
    "bias that is negative": ({"bias_covariance": -np.eye(2)}, "bias_covariance [[-1.0"),
    "doubt that is unknown": ({"sensor_pose_covariance": np.full((3, 3), NAN)}, "semidefinite"),
}  # fmt: skip


@pytest.mark.parametrize(("changes", "words"), BAD_ROWS.values(), ids=BAD_ROWS)
def test_a_row_that_no_tracker_can_use_is_refused_by_its_number(changes, words):
    with pytest.raises(MeasurementError) as caught:
        polar(**changes)
    message = str(caught.value)
    assert message.startswith("Row 1 of 3 measurements has ")
    assert words in message
    assert "expected: " in message


@pytest.mark.parametrize("changes", [case[0] for case in BAD_ROWS.values()], ids=BAD_ROWS)
def test_such_a_row_is_left_out_on_request(changes):
    assert polar(**changes, refuse="drop").values.tolist() == [[0.1, 1.0], [0.3, 3.0]]


@pytest.mark.parametrize(
    "covariance",
    [
        [[1.0, 2.0], [2.0, 1.0]],
        [[1.0, 0.5], [-0.5, 1.0]],
        [[1.0, 0.0], [0.0, 0.0]],
        [[-1.0, 0.0], [0.0, -1.0]],
        [[NAN, 0.0], [0.0, 1.0]],
        [[1.0, NAN], [NAN, 1.0]],
        [[INF, 0.0], [0.0, INF]],
    ],
    ids=["indefinite", "asymmetric", "flat", "negative", "nan", "nan beside", "infinite"],
)
def test_a_covariance_that_is_none_is_refused(covariance):
    noise = np.tile(np.eye(2), (3, 1, 1))
    noise[2] = covariance
    with pytest.raises(MeasurementError, match=r"Row 2 of 3 .* the covariance .* expected: a sym"):
        Measurements.cartesian(np.ones((3, 2)), noise)
    assert len(Measurements.cartesian(np.ones((3, 2)), noise, refuse="drop")) == 2


def test_a_covariance_in_the_plane_is_judged_as_its_eigenvalues_say():
    rng = np.random.default_rng(5)
    matrices = rng.standard_normal((200, 2, 2))
    matrices += np.swapaxes(matrices, 1, 2)
    line = rng.standard_normal((20, 2))
    flat = line[:, :, None] * line[:, None]
    is_none = np.linalg.eigvalsh(matrices)[:, 0] < 0.0
    assert are_semidefinite(matrices).tolist() == (~is_none).tolist()
    assert are_semidefinite(flat).all()


@pytest.mark.parametrize("bad", [NAN, INF, -1e9, 1e300])
def test_a_position_that_is_nowhere_is_refused(bad):
    with pytest.raises(MeasurementError, match=r"Row 0 of 1 .* the position"):
        Measurements.cartesian([bad, 1.0], np.eye(2))


def test_people_may_be_anywhere_on_earth():
    assert len(Measurements.cartesian([1e8, -1e8], np.eye(2))) == 1
    assert len(Measurements.polar(0.1, 2.0, 0.02, 0.1, (1e8, -1e8, 3.0))) == 1


def test_positions_with_correlated_noise_are_fine():
    assert len(Measurements.cartesian(np.ones((2, 2)), [[100.0, 3.0], [3.0, 0.1]])) == 2


def test_a_sensor_whose_place_is_uncertain_is_fine():
    doubt = np.diag([0.01, 0.01, 0.0])
    claims = Measurements.polar([0.1, 0.2], NAN, 0.02, 0.1, sensor_pose_covariance=doubt)
    np.testing.assert_array_equal(claims.sensor_pose_covariance, [doubt] * 2)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"kind": [0, 2, 7]}, "Row 2 .* kind 7; expected: a SensorKind"),
        ({"kind": [0, 2, -1]}, "Row 2 .* kind -1"),
        ({"kind": [0, 0, 0]}, "Row 1 .* the range nan m"),
        ({"kind": [2, 2, 0]}, "Row 0 .* kind BEARING; expected: NaN"),
        ({"covariance": np.tile(0.01 * np.eye(2), (3, 1, 1))}, "Row 1 .* expected: .* 1 and no"),
        ({"covariance": np.full((3, 2, 2), 0.5) + 0.5 * np.eye(2)}, "Row 1 .* the covariance"),
    ],
    ids=["unknown", "negative", "a range without", "a bearing with", "noise of nothing", "mixed"],
)
def test_changed_columns_are_checked_again(changes, words):
    with pytest.raises(MeasurementError, match=words):
        replace(GOOD, **changes)


def test_rows_chosen_and_joined_are_the_same_rows():
    chosen = Measurements.concatenate(GOOD[[2]], GOOD[:2])
    np.testing.assert_array_equal(chosen.values, GOOD.values[[2, 0, 1]])
    assert usable_rows(chosen).all()


@pytest.mark.parametrize("junk", [["a"], [{}], [[1.0], [1.0, 2.0]], "far"], ids=str)
@pytest.mark.parametrize("name", ["bearing_rad", "range_m", "range_std_m", "sensor_pose", "hand"])
def test_what_is_no_number_is_refused_by_name(name, junk):
    columns = {"bearing_rad": [0.1], "range_m": 2.0, "bearing_std_rad": 0.02, "range_std_m": 0.1}
    with pytest.raises(ShapeError, match=f"`{name}` is .*; expected an array of numbers"):
        Measurements.polar(**(columns | {name: junk}))


@pytest.mark.parametrize("number", [1.5, NAN, 2**63, np.array([2**64 - 1], np.uint64)], ids=str)
def test_a_number_of_a_tag_that_is_not_whole_or_too_large_is_refused(number):
    with pytest.raises(MeasurementError, match=r"`identity` is .* whole numbers below 2"):
        Measurements.ranges([2.0], 0.1, identity=number)


def test_another_way_to_refuse_is_unknown():
    with pytest.raises(MeasurementError, match="'raise' or 'drop'"):
        Measurements.polar(0.1, 2.0, 0.02, 0.1, refuse="ignore")


@settings(max_examples=300, deadline=None)
@given(
    columns=hnp.arrays(float, (4, 3), elements=st.one_of(st.floats(1e-3, 5.0), ANY)),
    pose=hnp.arrays(float, (3, 3), elements=st.one_of(st.floats(-10, 10), ANY)),
)
def test_rows_that_stay_are_those_that_are_accepted_alone(columns, pose):
    kept = Measurements.polar(*columns, pose, hand=[0, 1, 2], refuse="drop").hand.tolist()
    for row, column in enumerate(columns.T):
        if row in kept:
            assert len(Measurements.polar(*column, pose[row])) == 1
        else:
            with pytest.raises(MeasurementError):
                Measurements.polar(*column, pose[row])


def test_no_measurement_at_all_is_fine():
    assert len(Measurements.polar([], NAN, 0.02, 0.1)) == 0
    assert Measurements.none().kind.dtype == np.int64
    assert SensorKind.RANGE == 3
