import numpy as np
import pytest
from filterpy.kalman import IMMEstimator, KalmanFilter
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker import Config, Measurements
from tracker.tracking.association.association import associate
from tracker.tracking.prediction.modes import WEIGHT_MIN, merge_modes, weigh_modes
from tracker.tracking.prediction.motion import predict, stand, switching, walk
from tracker.tracking.sensing.claims import claims_of
from tracker.tracking.settings import settings_of
from tracker.tracking.update.correction import correct_people

# Nothing between the textbook and the code: no floor, and a gate as wide as can be.
CONFIG = Config(
    association="hungarian",
    outlier_dof=0.0,
    innovation_floor_m=0.0,
    gate_probability=1.0 - 1e-12,
    newcomer_density=1e-12,
)
NOISE = np.array([[0.04, 0.01], [0.01, 0.09]])


def random_modes(rng):
    """Weight, mean and covariance of one person in two modes."""
    root = rng.normal(scale=0.3, size=(2, 1, 4, 4))
    first = rng.uniform(0.05, 0.95)
    return (
        np.array([[first], [1.0 - first]]),
        rng.uniform([-3, -3, -1, -1], [3, 3, 1, 1]) + rng.normal(scale=0.1, size=(2, 1, 4)),
        root @ np.swapaxes(root, -1, -2) + 0.05 * np.eye(4),
    )


@settings(max_examples=50, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), dt_s=st.floats(0.02, 3.0))
def test_two_modes_are_filterpy_s_imm_estimator(
    people_of, pairs_of, merged, matrices_of, seed, dt_s
):
    rng = np.random.default_rng(seed)
    weight, mean, covariance = random_modes(rng)
    people = people_of(mean, covariance, weight)
    stops, starts = switching(dt_s, CONFIG.walk_duration_s, CONFIG.stand_duration_s)
    motions = walk(dt_s, CONFIG.acceleration_density), stand(dt_s, CONFIG.stand_speed_std_mps)
    filters = []
    for mode in range(2):
        oracle = KalmanFilter(dim_x=4, dim_z=2)
        oracle.x, oracle.P = mean[mode, 0].copy(), covariance[mode, 0].copy()
        oracle.F, oracle.Q = matrices_of(motions[mode])
        oracle.H, oracle.R = np.eye(2, 4), NOISE
        filters.append(oracle)
    chain = np.array([[1.0 - stops, stops], [starts, 1.0 - starts]])
    imm = IMMEstimator(filters, weight[:, 0].copy(), chain)
    for _ in range(3):
        imm.predict()
        z = imm.x[:2] + rng.normal(scale=0.2, size=2)
        imm.update(z)
        ahead = people_of(mean, covariance)
        predict(people, dt_s, settings_of(CONFIG), ahead)
        measured = Measurements.cartesian(z, NOISE)
        pairs = pairs_of(ahead, measured, CONFIG)
        _, probability = associate(pairs, 1, 1, settings_of(CONFIG))
        correct_people(ahead, claims_of(measured), pairs, probability, 0.0)
        people = ahead
    np.testing.assert_allclose(people.weight[:, 0], imm.mu, atol=1e-10)
    for mode in range(2):
        np.testing.assert_allclose(people.mean[mode, 0], filters[mode].x, atol=1e-10)
        np.testing.assert_allclose(people.covariance[mode, 0], filters[mode].P, atol=1e-10)
    one_mean, one_covariance = merged(people)
    np.testing.assert_allclose(one_mean[0], imm.x, atol=1e-10)
    np.testing.assert_allclose(one_covariance[0], imm.P, atol=1e-10)


def test_one_mode_merges_to_itself(people_of, merged):
    _, mean, covariance = random_modes(np.random.default_rng(1))
    found = merged(people_of(mean[:1], covariance[:1]))
    assert (found[0] == mean[0]).all()
    assert (found[1] == covariance[0]).all()


def test_two_modes_merge_to_the_moments_of_their_mixture():
    weight, mean, covariance = random_modes(np.random.default_rng(4))
    found, spread = np.empty((1, 4)), np.empty((1, 4, 4))
    merge_modes(weight, mean, covariance, found, spread)
    expected = (weight[..., None] * mean).sum(0)
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    off = mean - expected
    each = covariance + off[..., None] * off[..., None, :]
    np.testing.assert_allclose(spread, (weight[..., None, None] * each).sum(0), rtol=1e-12)


def test_far_from_the_origin_merging_loses_no_digits(people_of, merged):
    weight, mean, covariance = random_modes(np.random.default_rng(2))
    _, near = merged(people_of(mean, covariance, weight))
    _, far = merged(people_of(mean + 1e5, covariance, weight))
    np.testing.assert_allclose(far, near, atol=1e-9)


def test_modes_are_weighed_by_bayes_rule():
    weight = np.array([[0.2, 0.5], [0.8, 0.5]])
    weigh_modes(weight, 0, np.log([4.0, 1.0]))
    np.testing.assert_allclose(weight, [[0.5, 0.5], [0.5, 0.5]])


@pytest.mark.parametrize("log_likelihood", [(-1e4, 0.0), (-np.inf, -3.0)])
def test_no_mode_is_ever_excluded_for_good(log_likelihood):
    weight = np.array([[0.5], [0.5]])
    weigh_modes(weight, 0, np.array(log_likelihood))
    assert weight[0, 0] == pytest.approx(WEIGHT_MIN)
    assert weight.sum() == pytest.approx(1.0)
