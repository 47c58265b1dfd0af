import numpy as np
import pytest
from filterpy.common import Q_continuous_white_noise

from tracker import Config
from tracker.tracking.motion import (
    carry,
    motion_over,
    predict,
    process_noise,
    stand_noise,
    stand_transition,
    transition,
)


@pytest.mark.parametrize("dt_s", [0.01, 0.1, 1.0, 3.7])
@pytest.mark.parametrize("density", [0.05, 0.3, 4.0])
def test_process_noise_is_filterpy_s_continuous_white_noise(dt_s, density):
    oracle = Q_continuous_white_noise(
        dim=2, dt=dt_s, spectral_density=density, block_size=2, order_by_dim=False
    )
    np.testing.assert_allclose(process_noise(dt_s, density), oracle, rtol=1e-12)


def test_two_half_steps_of_prediction_equal_a_whole_one():
    rng = np.random.default_rng(3)
    mean = rng.normal(size=(5, 4))
    root = rng.normal(size=(5, 4, 4))
    covariance = root @ np.swapaxes(root, -1, -2)
    whole = predict(mean, covariance, 0.2, 0.3)
    half = predict(*predict(mean, covariance, 0.1, 0.3), 0.1, 0.3)
    np.testing.assert_allclose(half[0], whole[0], rtol=1e-12)
    np.testing.assert_allclose(half[1], whole[1], rtol=1e-12)


def test_no_time_changes_nothing():
    assert (transition(0.0) == np.eye(4)).all()
    assert (process_noise(0.0, 0.3) == 0.0).all()


@pytest.mark.parametrize("dt_s", [1e-4, 0.1, 2.0])
def test_standing_and_switching_too_depend_on_the_interval_alone(dt_s):
    rng = np.random.default_rng(4)
    mean = rng.normal(size=(2, 5, 4))
    root = rng.normal(size=(2, 5, 4, 4))
    covariance = root @ np.swapaxes(root, -1, -2)
    whole, half = motion_over(dt_s, Config()), motion_over(dt_s / 2, Config())
    for one, two in zip(
        carry(mean, covariance, whole),
        carry(*carry(mean, covariance, half), half),
        strict=True,
    ):
        np.testing.assert_allclose(two, one, rtol=1e-9)
    np.testing.assert_allclose(half.switching @ half.switching, whole.switching, rtol=1e-12)


def test_the_carried_covariance_is_that_of_the_matrices():
    rng = np.random.default_rng(5)
    mean, root = rng.normal(size=(2, 3, 4)), rng.normal(size=(2, 3, 4, 4))
    covariance = root @ np.swapaxes(root, -1, -2)
    motion = motion_over(0.3, Config())
    found = carry(mean, covariance, motion)
    for mode in range(2):
        step, noise = motion.transition[mode], motion.noise[mode]
        for row in range(3):
            expected = step @ covariance[mode, row] @ step.T + noise
            np.testing.assert_allclose(found[0][mode, row], step @ mean[mode, row], rtol=1e-12)
            np.testing.assert_allclose(found[1][mode, row], expected, rtol=1e-12)


def test_who_stands_hardly_drifts():
    after_8_s = stand_noise(8.0, 0.1)
    assert np.sqrt(after_8_s[0, 0]) < 0.3
    assert after_8_s[2, 2] == pytest.approx(0.01)
    assert (np.linalg.eigvalsh(after_8_s) > 0).all()
    assert stand_transition(8.0)[0, 2] == pytest.approx(0.5, abs=1e-6)
