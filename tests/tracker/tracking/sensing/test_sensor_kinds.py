"""What can each kind of sensor tell of somebody? Held against derivatives taken by differences."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import approx_fprime

from tracker import Config, Measurements
from tracker.containers import SensorKind
from tracker.tracking.sensing.claims import claims_of
from tracker.tracking.sensing.sensor_kinds import (
    RANGE_FLOOR_M,
    area,
    begin,
    expect,
    jacobian,
    pose_doubt,
    wrapped,
)
from tracker.tracking.settings import settings_of

CONFIG = Config()
SETTINGS = settings_of(CONFIG)
POSE = np.array([-1.0, 0.5, 0.7])
KINDS = pytest.mark.parametrize("kind", SensorKind, ids=lambda kind: kind.name)


def claim(kind, pose=POSE, range_m=3.0):
    """One measurement of a kind, at 0.4 rad and 3 m, or at (1, 2)."""
    if kind == SensorKind.POSITION:
        measured = Measurements.cartesian([1.0, 2.0], [[0.04, 0.01], [0.01, 0.09]])
    else:
        bearing_rad = np.nan if kind == SensorKind.RANGE else 0.4
        range_m = np.nan if kind == SensorKind.BEARING else range_m
        measured = Measurements.polar(bearing_rad, range_m, 0.05, 0.1, pose)
    assert measured.kind.tolist() == [kind]
    return claims_of(measured)


def by_hand(kind, place, pose):
    """h(x)."""
    dx, dy = np.asarray(place) - pose[:2]
    bearing_rad, range_m = np.arctan2(dy, dx) - pose[2], np.hypot(dx, dy)
    return {
        SensorKind.BEARING_RANGE: np.array([bearing_rad, range_m]),
        SensorKind.POSITION: np.array(place),
        SensorKind.BEARING: np.array([bearing_rad, 0.0]),
        SensorKind.RANGE: np.array([0.0, range_m]),
    }[kind]


def slope_of(function, at):
    return np.array([approx_fprime(at, lambda x, i=i: function(x)[i], 1e-7) for i in range(2)])


@given(angle=st.floats(-1e4, 1e4))
def test_a_wrapped_angle_is_the_same_direction_within_half_a_turn(angle):
    found = wrapped(angle)
    assert -np.pi <= found <= np.pi
    assert np.exp(1j * found) == pytest.approx(np.exp(1j * angle), abs=1e-9)


@KINDS
def test_a_sensor_expects_what_it_would_measure(kind):
    found = expect(int(kind), 2.0, 1.0, claim(kind), 0)
    assert found == pytest.approx(by_hand(kind, [2.0, 1.0], POSE))


@KINDS
def test_the_jacobian_is_the_derivative_of_what_is_expected(kind):
    expected = slope_of(lambda place: by_hand(kind, place, POSE), [2.0, 1.0])
    found = np.reshape(jacobian(int(kind), 2.0, 1.0, claim(kind), 0), (2, 2))
    np.testing.assert_allclose(found, expected, atol=1e-6)


@KINDS
def test_at_the_sensor_itself_everything_is_finite(kind):
    claims = claim(kind)
    assert np.isfinite(expect(int(kind), *POSE[:2], claims, 0)).all()
    slope = jacobian(int(kind), *POSE[:2], claims, 0)
    assert np.abs(slope).max() <= 1.0 / RANGE_FLOOR_M


@KINDS
def test_the_doubt_about_the_sensor_s_pose_is_its_first_order_propagation(kind):
    root = np.random.default_rng(5).normal(scale=0.1, size=(3, 3))
    doubt, place = root @ root.T, [2.0, 1.0]
    claims = claim(kind)._replace(doubt=doubt[None])
    slope = slope_of(lambda pose: by_hand(kind, place, pose), POSE)
    expected = slope @ doubt @ slope.T
    found = pose_doubt(*jacobian(int(kind), *place, claims, 0), claims, 0)
    assert found == pytest.approx((expected[0, 0], expected[0, 1], expected[1, 1]), abs=1e-6)


def test_an_uncertain_pose_makes_the_posterior_less_certain(corrected):
    root = np.random.default_rng(6).normal(scale=0.3, size=(4, 4))
    mean, covariance = np.array([[2.0, 1.0, 0.0, 0.0]]), (root @ root.T + 0.05 * np.eye(4))[None]
    sure = Measurements.polar(0.3, 3.0, 0.02, 0.05)
    unsure = replace(sure, sensor_pose_covariance=np.diag([0.01, 0.01, 0.01])[None])
    gained = corrected(mean, covariance, unsure)[1] - corrected(mean, covariance, sure)[1]
    assert np.linalg.eigvalsh(gained)[0, -1] > 1e-3
    assert np.linalg.eigvalsh(gained)[0, 0] > -1e-9


@pytest.mark.parametrize(
    ("kind", "expected"),
    [
        (SensorKind.BEARING_RANGE, 3.0),  # r dr dphi
        (SensorKind.BEARING, CONFIG.person_range_max_m**2 / 2.0),  # a full turn: pi r_max^2
        (SensorKind.RANGE, 2.0 * np.pi * 3.0),
        (SensorKind.POSITION, 1.0),
    ],
    ids=lambda value: getattr(value, "name", ""),
)
def test_a_density_over_the_floor_is_so_many_times_as_large_in_the_claim_s_numbers(kind, expected):
    assert area(int(kind), claim(kind), 0, SETTINGS) == pytest.approx(expected)


def begun(kind, **given):
    x, y, xx, xy, yy = begin(int(kind), claim(kind, **given), 0, SETTINGS)
    return np.array([x, y]), np.array([[xx, xy], [xy, yy]])


def test_someone_new_stands_where_the_measurement_says():
    place, spread = begun(SensorKind.BEARING_RANGE, pose=(1.0, 1.0, np.pi / 2 - 0.4), range_m=2.0)
    assert place == pytest.approx([1.0, 3.0])
    # Along x the bearing (2 m x 0.05 rad), along y the range, no correlation.
    np.testing.assert_allclose(spread, np.diag([0.01, 0.01]), atol=1e-12)


@pytest.mark.parametrize("kind", [SensorKind.BEARING_RANGE, SensorKind.BEARING])
def test_the_covariance_of_someone_new_is_first_order_propagation(kind):
    place, spread = begun(kind)
    range_m, range_std_m = 3.0, 0.1
    if kind == SensorKind.BEARING:
        range_m, range_std_m = CONFIG.unknown_range_m, CONFIG.unknown_range_std_m

    def placed(numbers):
        angle = numbers[0] + POSE[2]
        return POSE[:2] + numbers[1] * np.array([np.cos(angle), np.sin(angle)])

    slope = slope_of(placed, np.array([0.4, range_m]))
    assert place == pytest.approx(placed([0.4, range_m]))
    noise = np.diag([0.05**2, range_std_m**2])
    np.testing.assert_allclose(spread, slope @ noise @ slope.T, atol=1e-6)


def test_someone_new_is_as_uncertain_as_the_sensor_s_own_place():
    doubt = np.diag([0.3, 0.2, 0.0])
    kind = SensorKind.BEARING_RANGE
    _, _, xx, xy, yy = begin(kind, claim(kind)._replace(doubt=doubt[None]), 0, SETTINGS)
    _, sure = begun(kind)
    np.testing.assert_allclose([[xx, xy], [xy, yy]], sure + doubt[:2, :2], atol=1e-12)


def test_someone_new_by_a_position_is_as_uncertain_as_that():
    place, spread = begun(SensorKind.POSITION)
    assert place.tolist() == [1.0, 2.0]
    assert spread.tolist() == [[0.04, 0.01], [0.01, 0.09]]


def test_someone_new_by_a_range_alone_is_anywhere_on_a_ring():
    place, spread = begun(SensorKind.RANGE)
    assert place.tolist() == POSE[:2].tolist()
    rng = np.random.default_rng(8)
    angle, range_m = rng.uniform(0, 2 * np.pi, 100_000), 3.0 + 0.1 * rng.normal(size=100_000)
    drawn = np.cov(range_m * np.array([np.cos(angle), np.sin(angle)]))
    np.testing.assert_allclose(spread, drawn, atol=0.06)
