import numpy as np
import pytest

from tracker import Measurements
from tracker.tracking.filter import update
from tracker.tracking.motion import predict

MEAN = np.array([[3.0, 0.5, 0.2, 0.0]])
COVARIANCE = np.diag([0.02, 0.03, 0.2, 0.2])[None]


def test_with_many_degrees_of_freedom_it_is_the_gaussian_update():
    claims = Measurements.polar(0.17, 3.1, 0.03, 0.1)
    plain, tailed = update(MEAN, COVARIANCE, claims), update(MEAN, COVARIANCE, claims, 1e9)
    np.testing.assert_allclose(tailed[0], plain[0], atol=1e-6)
    np.testing.assert_allclose(tailed[1], plain[1], atol=1e-6)


def test_a_range_from_the_wall_behind_hardly_moves_anybody():
    claims = Measurements.polar(np.arctan2(0.5, 3.0), 6.0, 0.03, 0.1)
    plain, _ = update(MEAN, COVARIANCE, claims)
    tailed, spread = update(MEAN, COVARIANCE, claims, 4.0)
    assert plain[0, 0] > 4.0
    assert tailed[0, 0] == pytest.approx(3.0, abs=0.1)
    # ... and is known to have told next to nothing about the range.
    assert spread[0, 0, 0] > 0.8 * COVARIANCE[0, 0, 0]


def test_a_bearing_alone_has_no_range_to_doubt():
    claims = Measurements.polar(0.3, np.nan, 0.03, 0.1)
    np.testing.assert_array_equal(
        update(MEAN, COVARIANCE, claims, 4.0)[0], update(MEAN, COVARIANCE, claims)[0]
    )


def test_five_percent_of_outliers_lose_nobody():
    rng = np.random.default_rng(3)
    trials, errors = 400, {0.0: [], 4.0: []}
    for dof, kept in errors.items():
        mean, covariance = np.repeat(MEAN, trials, 0), np.repeat(COVARIANCE, trials, 0)
        truth = mean + rng.normal(size=mean.shape) * np.sqrt(COVARIANCE[0].diagonal())
        for _ in range(60):
            truth = truth + 0.1 * np.pad(truth[:, 2:], ((0, 0), (0, 2)))
            mean, covariance = predict(mean, covariance, 0.1, 0.01)
            range_m = np.hypot(truth[:, 0], truth[:, 1]) + rng.normal(scale=0.08, size=trials)
            range_m += np.where(rng.random(trials) < 0.05, rng.normal(scale=2.0, size=trials), 0)
            bearing = np.arctan2(truth[:, 1], truth[:, 0]) + rng.normal(scale=0.03, size=trials)
            claims = Measurements.polar(bearing, np.maximum(range_m, 0.0), 0.03, 0.08)
            mean, covariance = update(mean, covariance, claims, dof)
            kept.append(np.hypot(*(mean - truth)[:, :2].T))
    assert np.max(errors[4.0]) < 1.0
    assert np.mean(errors[4.0]) < 0.6 * np.mean(errors[0.0])
