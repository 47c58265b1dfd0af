import numpy as np
import pytest
from filterpy.common import Q_continuous_white_noise

from tracker.tracking.motion import predict, process_noise, transition


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
