import numpy as np
import pytest
from filterpy.kalman import ExtendedKalmanFilter, KalmanFilter
from scipy.optimize import approx_fprime

from tracker import Measurements
from tracker.tracking.filter import initial_state, innovations, update


@pytest.fixture
def random_tracks():
    rng = np.random.default_rng(7)
    mean = rng.uniform([-3, -3, -1, -1], [3, 3, 1, 1], size=(20, 4))
    root = rng.normal(scale=0.3, size=(20, 4, 4))
    return mean, root @ np.swapaxes(root, -1, -2) + 0.05 * np.eye(4)


def to_polar(state, pose):
    dx, dy = state[0] - pose[0], state[1] - pose[1]
    return np.array([np.arctan2(dy, dx) - pose[2], np.hypot(dx, dy)])


def test_a_polar_update_is_filterpy_s_extended_kalman_filter(random_tracks):
    mean, covariance = random_tracks
    rng = np.random.default_rng(8)
    pose = np.array([4.0, 5.0, -2.2])
    values = np.array([to_polar(row, pose) for row in mean])
    values += rng.normal(scale=[0.03, 0.1], size=values.shape)
    claims = Measurements.polar(values[:, 0], values[:, 1], 0.03, 0.1, pose)
    posterior_mean, posterior_covariance = update(mean, covariance, claims)
    for row in range(len(mean)):
        oracle = ExtendedKalmanFilter(dim_x=4, dim_z=2)
        oracle.x, oracle.P = mean[row].copy(), covariance[row].copy()
        oracle.R = np.diag([0.03**2, 0.1**2])
        oracle.update(
            values[row],
            HJacobian=lambda x: np.array(
                [approx_fprime(x, lambda s, i=i: to_polar(s, pose)[i], 1e-7) for i in range(2)]
            ),
            Hx=lambda x: to_polar(x, pose),
        )
        np.testing.assert_allclose(posterior_mean[row], oracle.x, atol=1e-5)
        np.testing.assert_allclose(posterior_covariance[row], oracle.P, atol=1e-5)


def test_a_cartesian_update_is_filterpy_s_kalman_filter(random_tracks):
    mean, covariance = random_tracks
    rng = np.random.default_rng(9)
    xy = mean[:, :2] + rng.normal(scale=0.2, size=(len(mean), 2))
    noise = np.array([[0.04, 0.01], [0.01, 0.09]])
    posterior_mean, posterior_covariance = update(
        mean, covariance, Measurements.cartesian(xy, noise)
    )
    for row in range(len(mean)):
        oracle = KalmanFilter(dim_x=4, dim_z=2)
        oracle.x, oracle.P = mean[row].copy(), covariance[row].copy()
        oracle.H, oracle.R = np.eye(2, 4), noise
        oracle.update(xy[row])
        np.testing.assert_allclose(posterior_mean[row], oracle.x, atol=1e-10)
        np.testing.assert_allclose(posterior_covariance[row], oracle.P, atol=1e-10)


def test_a_bearing_alone_is_a_one_dimensional_update(random_tracks):
    mean, covariance = random_tracks
    pose = np.zeros(3)
    bearing = np.array([to_polar(row, pose)[0] for row in mean]) + 0.02
    claims = Measurements.polar(bearing, np.nan, 0.05, 0.1, pose)
    posterior_mean, posterior_covariance = update(mean, covariance, claims)
    for row in range(len(mean)):
        dx, dy = mean[row, :2]
        jacobian = np.array([[-dy, dx, 0.0, 0.0]]) / (dx**2 + dy**2)
        spread = (jacobian @ covariance[row] @ jacobian.T).item() + 0.05**2
        gain = covariance[row] @ jacobian.T / spread
        np.testing.assert_allclose(posterior_mean[row], mean[row] + 0.02 * gain[:, 0], atol=1e-10)
        expected = (np.eye(4) - gain @ jacobian) @ covariance[row]
        np.testing.assert_allclose(posterior_covariance[row], expected, atol=1e-10)


def test_bearing_innovation_wraps_across_pi():
    mean = np.array([[-2.0, -0.01, 0.0, 0.0]])
    claims = Measurements.polar(np.pi - 0.01, 2.0, 0.05, 0.1)
    innovation, _ = innovations(mean, np.eye(4)[None], claims)
    assert innovation[0, 0, 0] == pytest.approx(-0.015, abs=1e-4)


def test_someone_new_stands_where_the_measurement_says():
    claims = Measurements.polar(np.pi / 2, 2.0, 0.05, 0.1, (1.0, 1.0, 0.0))
    mean, covariance = initial_state(
        claims, unknown_range_m=2.5, unknown_range_std_m=1.5, speed_std_mps=0.5
    )
    assert mean[0] == pytest.approx([1.0, 3.0, 0.0, 0.0])
    # Along x the bearing (2 m x 0.05 rad), along y the range, no correlation.
    assert np.diag(covariance[0]) == pytest.approx([0.01, 0.01, 0.25, 0.25])
    assert covariance[0, 0, 1] == pytest.approx(0.0, abs=1e-12)


def test_someone_new_without_range_is_supposed_at_the_unknown_range():
    claims = Measurements.polar(0.0, np.nan, 0.05, 0.1)
    mean, covariance = initial_state(
        claims, unknown_range_m=2.5, unknown_range_std_m=1.5, speed_std_mps=0.5
    )
    assert mean[0, :2] == pytest.approx([2.5, 0.0])
    assert covariance[0, 0, 0] == pytest.approx(1.5**2)


def test_covariances_stay_symmetric_positive_definite_over_many_updates(random_tracks):
    mean, covariance = random_tracks
    for _ in range(200):
        claims = Measurements.polar(np.full(len(mean), 0.3), 2.0, 1e-3, 1e-3)
        mean, covariance = update(mean, covariance, claims)
    np.testing.assert_array_equal(covariance, np.swapaxes(covariance, -1, -2))
    assert (np.linalg.eigvalsh(covariance) > 0).all()
