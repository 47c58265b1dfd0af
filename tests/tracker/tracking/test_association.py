from itertools import permutations

import numpy as np
import pytest
from scipy.stats import chi2

from tracker import Measurements
from tracker.tracking.association import associate, gate, squared_distances
from tracker.tracking.filter import innovations


def random_case(rng, tracks, claims):
    mean = np.concatenate([rng.uniform(0, 2, (tracks, 2)), np.zeros((tracks, 2))], axis=1)
    covariance = np.tile(np.diag([0.1, 0.2, 1.0, 1.0]), (tracks, 1, 1))
    measured = Measurements.cartesian(rng.uniform(0, 2, (claims, 2)), 0.05 * np.eye(2))
    return innovations(mean, covariance, measured), measured


def test_the_gate_keeps_the_share_it_is_told():
    rng = np.random.default_rng(5)
    spread = np.array([[0.3, 0.1], [0.1, 0.2]])
    draws = rng.multivariate_normal([0, 0], spread, size=20_000)
    measured = Measurements.cartesian(draws, np.eye(2))
    distances = squared_distances(draws[None], np.tile(spread, (1, 20_000, 1, 1)))
    inside, _ = gate(distances, measured, 0.9)
    # Five standard errors of a binomial share.
    assert inside.mean() == pytest.approx(0.9, abs=5 * np.sqrt(0.9 * 0.1 / 20_000))


def test_a_bearing_alone_is_gated_with_one_degree_of_freedom():
    claims = Measurements.polar([0.0, 0.0], [np.nan, 1.0], 0.1, 0.1)
    _, limit = gate(np.zeros((1, 2)), claims, 0.99)
    assert limit == pytest.approx([chi2.ppf(0.99, 1), chi2.ppf(0.99, 2)])


@pytest.mark.parametrize(("tracks", "claims"), [(1, 3), (2, 2), (3, 2), (4, 4), (3, 4)])
def test_the_assignment_is_as_good_as_the_best_of_all(tracks, claims):
    rng = np.random.default_rng(tracks * 10 + claims)
    for _ in range(20):
        (innovation, spread), measured = random_case(rng, tracks, claims)
        chosen = associate(innovation, spread, measured, 0.99)
        inside, limit = gate(squared_distances(innovation, spread), measured, 0.99)
        noise = np.linalg.slogdet(measured.covariance)[1]
        cost = squared_distances(innovation, spread) + np.linalg.slogdet(spread)[1] - noise
        gain = np.where(inside, cost - limit - 8.0, 0.0)

        def total(choice, gain=gain):
            return sum(gain[row, column] for row, column in enumerate(choice) if column >= 0)

        options = [*range(claims), *[-1] * tracks]
        best = min(total(choice) for choice in set(permutations(options, tracks)))
        assert total(chosen) == pytest.approx(best)


def test_nobody_gets_a_measurement_outside_the_gate():
    mean = np.zeros((1, 4))
    measured = Measurements.cartesian([[5.0, 5.0]], 0.01 * np.eye(2))
    innovation, spread = innovations(mean, 0.01 * np.eye(4)[None], measured)
    assert associate(innovation, spread, measured, 0.99).tolist() == [-1]


def test_no_tracks_or_no_measurements_are_no_trouble():
    measured = Measurements.cartesian([[0.0, 0.0]], np.eye(2))
    nobody = innovations(np.zeros((0, 4)), np.zeros((0, 4, 4)), measured)
    assert associate(*nobody, measured, 0.99).tolist() == []
    nothing = innovations(np.zeros((2, 4)), np.tile(np.eye(4), (2, 1, 1)), Measurements.none())
    assert associate(*nothing, Measurements.none(), 0.99).tolist() == [-1, -1]
