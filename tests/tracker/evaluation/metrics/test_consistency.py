import numpy as np
import pytest
from scipy.stats import chi2

from tracker.evaluation.metrics.consistency import mean_bounds, normalized_squared


def random_states(rng, count, dimensions):
    root = rng.normal(size=(count, dimensions, dimensions))
    covariance = root @ np.swapaxes(root, -1, -2) + 0.1 * np.eye(dimensions)
    return rng.normal(size=(count, dimensions)), covariance


@pytest.mark.parametrize("dimensions", [2, 4], ids=["NIS", "NEES"])
def test_normalized_errors_equal_stone_soup_s(stonesoup, dimensions):
    from stonesoup.measures import SquaredMahalanobis
    from stonesoup.types.state import GaussianState, State

    error, covariance = random_states(np.random.default_rng(1), 50, dimensions)
    found = normalized_squared(error, covariance)
    for row in range(len(error)):
        estimate = GaussianState(np.zeros(dimensions), covariance[row])
        assert found[row] == pytest.approx(SquaredMahalanobis()(estimate, State(error[row])))


def test_the_mean_of_true_claims_keeps_to_the_bounds_as_often_as_promised():
    rng = np.random.default_rng(2)
    _, covariance = random_states(rng, 1, 4)
    root = np.linalg.cholesky(covariance[0])
    error = rng.normal(size=(4000, 50, 4)) @ root.T
    means = normalized_squared(error, np.broadcast_to(covariance[0], (4000, 50, 4, 4))).mean(
        axis=1
    )
    low, high = mean_bounds(4, 50, probability=0.9)
    inside = np.mean((low <= means) & (means <= high))
    assert inside == pytest.approx(0.9, abs=4 * np.sqrt(0.9 * 0.1 / 4000))


def test_bounds_of_one_sample_are_chi_square_s_own():
    assert mean_bounds(2, 1, 0.95) == pytest.approx(tuple(chi2.ppf([0.025, 0.975], 2)))
