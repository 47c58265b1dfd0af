import numpy as np
import pytest

from tracker import Measurements
from tracker.containers import SensorKind
from tracker.tracking.sensing.claims import claims_of
from tracker.tracking.sensing.innovation import innovation_of, noise_of, projected, seen_from
from tracker.tracking.sensing.sensor_kinds import jacobian

NOISE = np.array([[0.04, 0.01], [0.01, 0.09]])


def claim_of(measured):
    return int(measured.kind[0]), claims_of(measured)


def innovation(state, measured):
    kind, claims = claim_of(measured)
    mean = np.reshape(np.array(state, dtype=float), (1, 1, 4))
    expected, *_ = seen_from(kind, mean, np.eye(4)[None, None], 0, 0, claims, 0)
    return innovation_of(kind, expected, claims, 0)


def test_bearing_innovation_wraps_across_pi():
    measured = Measurements.polar(np.pi - 0.01, 2.0, 0.05, 0.1)
    bearing, range_m = innovation([-2.0, -0.01, 0.0, 0.0], measured)
    assert bearing == pytest.approx(-0.015, abs=1e-4)
    assert range_m == pytest.approx(0.0, abs=1e-4)


def test_a_position_s_innovation_does_not_wrap():
    measured = Measurements.cartesian([5.0, -7.0], NOISE)
    assert innovation([-2.0, 1.0, 0.0, 0.0], measured) == (7.0, -8.0)


def test_a_number_that_is_missing_differs_by_nothing_and_has_variance_1():
    bearing = Measurements.bearings(0.5, 0.1)
    distance = Measurements.ranges(3.0, 0.2)
    assert innovation([2.0, 0.0, 0.0, 0.0], bearing) == pytest.approx((0.5, 0.0))
    assert innovation([2.0, 0.0, 0.0, 0.0], distance) == pytest.approx((0.0, 1.0))
    noises = [noise_of(kind, claims, 0) for kind, claims in map(claim_of, (bearing, distance))]
    assert noises == [pytest.approx((0.01, 0.0, 1.0)), pytest.approx((1.0, 0.0, 0.04))]


def test_the_noise_of_two_numbers_is_the_one_that_was_stated():
    measured = Measurements.cartesian([5.0, -7.0], NOISE)
    assert noise_of(*claim_of(measured), 0) == (0.04, 0.01, 0.09)


@pytest.mark.parametrize("kind", SensorKind, ids=lambda kind: kind.name)
def test_what_a_track_contributes_is_h_p_h(kind):
    rng = np.random.default_rng(3)
    root = rng.normal(size=(2, 3, 4, 4))
    covariance = root @ np.swapaxes(root, -1, -2)
    _, claims = claim_of(Measurements.polar(0.0, 1.0, 0.1, 0.1, (4.0, 5.0, -2.2)))
    h = jacobian(int(kind), 1.0, 2.0, claims, 0)
    matrix = np.pad(np.reshape(h, (2, 2)), ((0, 0), (0, 2)))
    expected = matrix @ covariance[1, 2] @ matrix.T
    found = projected(covariance, 1, 2, h)
    assert found == pytest.approx((expected[0, 0], expected[0, 1], expected[1, 1]))
