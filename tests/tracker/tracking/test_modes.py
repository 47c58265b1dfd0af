import numpy as np
import pytest
from filterpy.kalman import IMMEstimator, KalmanFilter
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker import Config, Measurements
from tracker.tracking.gating import find_pairs
from tracker.tracking.modes import Belief, predict_modes
from tracker.tracking.motion import motion_over
from tracker.tracking.posterior import update_assigned

# Nothing between the textbook and the code: no floor, and a gate as wide as can be.
CONFIG = Config(outlier_dof=0.0, innovation_floor_m=0.0, gate_probability=1.0 - 1e-12)
NOISE = np.array([[0.04, 0.01], [0.01, 0.09]])


def random_belief(rng):
    root = rng.normal(scale=0.3, size=(2, 1, 4, 4))
    first = rng.uniform(0.05, 0.95)
    return Belief(
        np.array([[first], [1.0 - first]]),
        rng.uniform([-3, -3, -1, -1], [3, 3, 1, 1]) + rng.normal(scale=0.1, size=(2, 1, 4)),
        root @ np.swapaxes(root, -1, -2) + 0.05 * np.eye(4),
    )


@settings(max_examples=50, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), dt_s=st.floats(0.02, 3.0))
def test_two_modes_are_filterpy_s_imm_estimator(seed, dt_s):
    rng = np.random.default_rng(seed)
    belief, motion = random_belief(rng), motion_over(dt_s, CONFIG)
    filters = []
    for mode in range(2):
        oracle = KalmanFilter(dim_x=4, dim_z=2)
        oracle.x, oracle.P = belief.mean[mode, 0].copy(), belief.covariance[mode, 0].copy()
        oracle.F, oracle.Q = motion.transition[mode], motion.noise[mode]
        oracle.H, oracle.R = np.eye(2, 4), NOISE
        filters.append(oracle)
    imm = IMMEstimator(filters, belief.weight[:, 0].copy(), motion.switching)
    for _ in range(3):
        imm.predict()
        z = imm.x[:2] + rng.normal(scale=0.2, size=2)
        imm.update(z)
        belief = predict_modes(belief, motion)
        pairs = find_pairs(belief, Measurements.cartesian(z, NOISE), CONFIG)
        belief = update_assigned(belief, pairs)
    np.testing.assert_allclose(belief.weight[:, 0], imm.mu, atol=1e-10)
    for mode in range(2):
        np.testing.assert_allclose(belief.mean[mode, 0], filters[mode].x, atol=1e-10)
        np.testing.assert_allclose(belief.covariance[mode, 0], filters[mode].P, atol=1e-10)
    mean, covariance = belief.merged()
    np.testing.assert_allclose(mean[0], imm.x, atol=1e-10)
    np.testing.assert_allclose(covariance[0], imm.P, atol=1e-10)


def test_one_mode_merges_to_itself():
    belief = random_belief(np.random.default_rng(1))
    one = Belief(np.ones((1, 1)), belief.mean[:1], belief.covariance[:1])
    mean, covariance = one.merged()
    assert (mean == one.mean[0]).all()
    assert (covariance == one.covariance[0]).all()


def test_far_from_the_origin_merging_loses_no_digits():
    belief = random_belief(np.random.default_rng(2))
    _, near = belief.merged()
    _, far = Belief(belief.weight, belief.mean + 1e5, belief.covariance).merged()
    np.testing.assert_allclose(far, near, atol=1e-9)


def test_changing_the_number_of_modes_keeps_place_and_moments():
    belief = random_belief(np.random.default_rng(3))
    one = belief.with_modes(1, 0.1)
    np.testing.assert_allclose(one.merged()[1], belief.merged()[1])
    assert one.with_modes(2, 0.1).weight[:, 0] == pytest.approx([0.5, 0.5])
