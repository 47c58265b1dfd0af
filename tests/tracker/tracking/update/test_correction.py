"""What a measurement makes of a track is what FilterPy's Kalman filters make of it."""

import numpy as np
import pytest
from filterpy.kalman import ExtendedKalmanFilter, KalmanFilter
from hypothesis import given
from hypothesis import strategies as st

from tracker import Config, Measurements
from tracker.tracking.sensing.claims import claims_of
from tracker.tracking.update.correction import correct_people

PLAIN = Config(motion="cv", outlier_dof=0.0, innovation_floor_m=0.0, gate_probability=1.0 - 1e-12)
NOISE = np.array([[0.04, 0.01], [0.01, 0.09]])


def random_tracks(rng, count):
    mean = rng.uniform([-3, -3, -1, -1], [3, 3, 1, 1], size=(count, 4))
    root = rng.normal(scale=0.3, size=(count, 4, 4))
    return mean, root @ np.swapaxes(root, -1, -2) + 0.05 * np.eye(4)


def polar_of(state, pose):
    dx, dy = state[0] - pose[0], state[1] - pose[1]
    return np.array([np.arctan2(dy, dx) - pose[2], np.hypot(dx, dy)])


def slope_of(state, pose):
    dx, dy = state[0] - pose[0], state[1] - pose[1]
    square = dx**2 + dy**2
    root = np.sqrt(square)
    return np.array([[-dy / square, dx / square, 0, 0], [dx / root, dy / root, 0, 0]])


def extended_by_filterpy(mean, covariance, value, noise, numbers, pose):
    """FilterPy's posterior by some of bearing and range."""
    oracle = ExtendedKalmanFilter(dim_x=4, dim_z=len(numbers))
    oracle.x, oracle.P, oracle.R = mean.copy(), covariance.copy(), noise
    oracle.update(
        value, lambda x: slope_of(x, pose)[numbers], lambda x: polar_of(x, pose)[numbers]
    )
    return oracle.x, oracle.P


@given(seed=st.integers(0, 2**32 - 1))
def test_an_update_by_bearing_and_range_is_filterpy_s_to_ten_digits(corrected, seed):
    rng = np.random.default_rng(seed)
    mean, covariance = random_tracks(rng, 1)
    away = 4.0 * np.exp(1j * rng.uniform(0, 2 * np.pi))
    pose = np.array([*(mean[0, :2] + [away.real, away.imag]), rng.uniform(-np.pi, np.pi)])
    value = polar_of(mean[0], pose) + rng.normal(scale=[0.03, 0.1])
    std = [0.03, 0.1]
    measured = {
        (0, 1): Measurements.polar(*value, *std, pose),
        (0,): Measurements.bearings(value[0], std[0], pose),
        (1,): Measurements.ranges(value[1], std[1], pose),
    }
    for numbers, claims in measured.items():
        found = corrected(mean, covariance, claims)
        some, noise = list(numbers), np.diag(np.square([std[each] for each in numbers]))
        oracle = extended_by_filterpy(mean[0], covariance[0], value[some], noise, some, pose)
        np.testing.assert_allclose(found[0][0], oracle[0], atol=1e-10)
        np.testing.assert_allclose(found[1][0], oracle[1], atol=1e-10)


def test_an_update_by_positions_is_filterpy_s_kalman_filter(corrected):
    rng = np.random.default_rng(9)
    mean, covariance = random_tracks(rng, 20)
    xy = mean[:, :2] + rng.normal(scale=0.2, size=(20, 2))
    found = corrected(mean, covariance, Measurements.cartesian(xy, NOISE))
    for row in range(20):
        oracle = KalmanFilter(dim_x=4, dim_z=2)
        oracle.x, oracle.P = mean[row].copy(), covariance[row].copy()
        oracle.H, oracle.R = np.eye(2, 4), NOISE
        oracle.update(xy[row])
        np.testing.assert_allclose(found[0][row], oracle.x, atol=1e-10)
        np.testing.assert_allclose(found[1][row], oracle.P, atol=1e-10)


def test_a_bearing_alone_is_a_one_dimensional_update(corrected):
    mean, covariance = random_tracks(np.random.default_rng(7), 20)
    bearing_rad = np.arctan2(mean[:, 1], mean[:, 0]) + 0.02
    found = corrected(mean, covariance, Measurements.bearings(bearing_rad, 0.05))
    for row in range(20):
        jacobian = slope_of(mean[row], np.zeros(3))[:1]
        spread = (jacobian @ covariance[row] @ jacobian.T).item() + 0.05**2
        gain = covariance[row] @ jacobian.T / spread
        np.testing.assert_allclose(found[0][row], mean[row] + 0.02 * gain[:, 0], atol=1e-10)
        expected = (np.eye(4) - gain @ jacobian) @ covariance[row]
        np.testing.assert_allclose(found[1][row], expected, atol=1e-10)


def test_covariances_stay_symmetric_positive_definite_over_many_updates(corrected):
    mean, covariance = random_tracks(np.random.default_rng(7), 5)
    for _ in range(200):
        claims = Measurements.polar(np.full(len(mean), 0.3), 2.0, 1e-3, 1e-3)
        mean, covariance = corrected(mean, covariance, claims)
    np.testing.assert_array_equal(covariance, np.swapaxes(covariance, -1, -2))
    assert (np.linalg.eigvalsh(covariance) > 0).all()


def test_hardly_any_noise_against_hardly_any_knowledge_leaves_a_covariance(corrected):
    mean, covariance = random_tracks(np.random.default_rng(8), 5)
    exactly = Measurements.cartesian(mean[:, :2] + 0.1, 1e-11 * np.eye(2))
    moved, spread = corrected(mean, 1e6 * covariance, exactly)
    np.testing.assert_allclose(moved[:, :2], mean[:, :2] + 0.1, atol=1e-6)
    assert (np.linalg.eigvalsh(spread) > 0).all()


def test_one_track_is_the_pda_filter(people_of, pairs_of):
    mean, covariance = np.array([1.0, 2.0, 0.1, 0.0]), np.diag([0.2, 0.3, 0.5, 0.5])
    people, noise = people_of(mean[None], covariance), 0.05 * np.eye(2)
    measured = Measurements.cartesian([[1.3, 2.1], [0.8, 1.6]], noise)
    pairs, share = pairs_of(people, measured, PLAIN), np.array([0.5, 0.3])
    correct_people(people, claims_of(measured), pairs, share, 0.0)

    observe = np.eye(2, 4)
    spread = observe @ covariance @ observe.T + noise
    gain = covariance @ observe.T @ np.linalg.inv(spread)
    each = measured.values - mean[:2]
    together = share @ each
    np.testing.assert_allclose(people.mean[0, 0], mean + gain @ together, atol=1e-12)
    between = (share[:, None, None] * each[:, :, None] * each[:, None]).sum(0)
    between -= np.outer(together, together)
    expected = covariance - 0.8 * gain @ spread @ gain.T + gain @ between @ gain.T
    np.testing.assert_allclose(people.covariance[0, 0], expected, atol=1e-12)


def test_modes_that_explain_the_measurements_better_gain_weight(people_of, pairs_of):
    mean = np.array([[[1.0, 0.0, 0.0, 0.0]], [[1.6, 0.0, 0.0, 0.0]]])
    people = people_of(mean, 0.05 * np.eye(4), [[0.4], [0.6]])
    measured = Measurements.cartesian([[1.1, 0.1], [1.4, -0.1]], 0.05 * np.eye(2))
    config = PLAIN.replace(motion="imm")
    pairs, probability = pairs_of(people, measured, config), np.array([0.6, 0.1])
    likely = np.exp(pairs.log_likelihood)
    correct_people(people, claims_of(measured), pairs, probability, 0.0)

    weight = np.array([0.4, 0.6])
    ratio = likely / (likely @ weight)[:, None]
    evidence = 0.3 + probability @ ratio
    np.testing.assert_allclose(people.weight[:, 0], weight * evidence, atol=1e-12)
    share = probability[:, None] * ratio / evidence
    for mode in range(2):
        toward = 0.5 * (measured.values - mean[mode, 0, :2])  # P / (P + R) is one half
        expected = mean[mode, 0, :2] + share[:, mode] @ toward
        np.testing.assert_allclose(people.mean[mode, 0, :2], expected, atol=1e-12)


def test_who_has_no_pair_stays_as_predicted(people_of, pairs_of):
    people = people_of(*random_tracks(np.random.default_rng(3), 4))
    before = [each.copy() for each in people]
    near = Measurements.cartesian(people.mean[0, [2], :2], 0.01 * np.eye(2))
    pairs = pairs_of(people, near, PLAIN)
    correct_people(people, claims_of(near), pairs, np.where(pairs.track == 2, 0.7, 0.0), 0.0)
    others = [0, 1, 3]
    for now, then in zip(people[:3], before[:3], strict=True):
        np.testing.assert_array_equal(now[:, others], then[:, others])
    assert (people.covariance[0, 2] != before[2][0, 2]).any()


def test_far_from_the_origin_hypotheses_are_mixed_as_near_it(people_of, pairs_of):
    posterior = []
    for far in (0.0, 2.0**20):
        people = people_of([[1.0 + far, 2.0, 0.1, 0.0]], np.diag([0.2, 0.3, 0.5, 0.5]))
        points = np.array([[1.25 + far, 2.125], [0.75 + far, 1.625]])
        measured = Measurements.cartesian(points, 0.05 * np.eye(2))
        pairs = pairs_of(people, measured, PLAIN)
        claims = claims_of(measured)
        correct_people(people, claims, pairs, np.array([0.5, 0.3]), 0.0)
        posterior.append((people.mean[0, 0] - [far, 0, 0, 0], people.covariance[0, 0]))
    for near, away in zip(*posterior, strict=True):
        assert away == pytest.approx(near, abs=1e-9)
