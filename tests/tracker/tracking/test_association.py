from itertools import permutations

import numpy as np
import pytest
from scipy.stats import chi2, multivariate_normal

from tracker import Config, Measurements
from tracker.tracking.association import assign, log_odds
from tracker.tracking.gating import find_pairs, gate_limit, squared_distance
from tracker.tracking.modes import Belief

CONFIG = Config(motion="cv", outlier_dof=0.0, innovation_floor_m=0.0)


def belief_at(xy, covariance):
    mean = np.concatenate([xy, np.zeros((len(xy), 2))], axis=1)
    return Belief(np.ones((1, len(xy))), mean[None], np.tile(covariance, (1, len(xy), 1, 1)))


def random_case(rng, tracks, claims):
    belief = belief_at(rng.uniform(0, 2, (tracks, 2)), np.diag([0.1, 0.2, 1.0, 1.0]))
    measured = Measurements.cartesian(rng.uniform(0, 2, (claims, 2)), 0.05 * np.eye(2))
    return belief, measured


def odds_of(belief, measured, detection=0.9, config=CONFIG):
    pairs = find_pairs(belief, measured, config)
    chance = np.full(belief.weight.shape[1], detection)
    return pairs, log_odds(pairs, belief.weight, chance)


def test_the_gate_keeps_the_share_it_is_told():
    rng = np.random.default_rng(5)
    spread = np.array([[0.3, 0.1], [0.1, 0.2]])
    draws = rng.multivariate_normal([0, 0], spread, size=20_000)
    distances, _ = squared_distance(draws, np.tile(spread, (20_000, 1, 1)))
    inside = distances <= gate_limit(True, 0.9)
    # Five standard errors of a binomial share.
    assert inside.mean() == pytest.approx(0.9, abs=5 * np.sqrt(0.9 * 0.1 / 20_000))


def test_a_bearing_alone_is_gated_with_one_degree_of_freedom():
    limit = [gate_limit(False, 0.99), gate_limit(True, 0.99)]
    assert limit == pytest.approx([chi2.ppf(0.99, 1), chi2.ppf(0.99, 2)])


def test_the_odds_of_a_pair_are_those_of_the_textbook():
    belief = belief_at(np.array([[1.0, 0.5]]), np.diag([0.1, 0.2, 1.0, 1.0]))
    measured = Measurements.cartesian([[1.2, 0.4]], 0.05 * np.eye(2))
    _, odds = odds_of(belief, measured, detection=0.8)
    spread = np.diag([0.15, 0.25])
    likelihood = multivariate_normal([1.0, 0.5], spread).pdf([1.2, 0.4])
    expected = np.log(0.8 * likelihood / (0.2 * CONFIG.newcomer_density))
    assert odds == pytest.approx([expected])


@pytest.mark.parametrize(("tracks", "claims"), [(1, 3), (2, 2), (3, 2), (4, 4), (3, 4)])
def test_the_assignment_is_as_good_as_the_best_of_all(tracks, claims):
    rng = np.random.default_rng(tracks * 10 + claims)
    for _ in range(20):
        pairs, odds = odds_of(*random_case(rng, tracks, claims))
        gain = np.zeros((tracks, claims))
        gain[pairs.track, pairs.claim] = np.maximum(odds, 0.0)
        chosen = assign(pairs, odds, tracks)
        taken = chosen[chosen >= 0]
        assert len(set(pairs.claim[taken])) == len(taken)

        def total(choice, gain=gain):
            return sum(gain[row, column] for row, column in enumerate(choice) if column >= 0)

        options = [*range(claims), *[-1] * tracks]
        best = max(total(choice) for choice in set(permutations(options, tracks)))
        assert odds[taken].sum() == pytest.approx(best)


def test_a_crowd_is_assigned_as_one_dense_matrix_would_be():
    from scipy.optimize import linear_sum_assignment

    rng = np.random.default_rng(11)
    xy = rng.uniform(0, 12, (150, 2))
    belief = belief_at(xy, np.diag([0.1, 0.1, 1.0, 1.0]))
    measured = Measurements.cartesian(
        rng.permutation(xy) + rng.normal(scale=0.3, size=xy.shape), 0.05 * np.eye(2)
    )
    pairs, odds = odds_of(belief, measured)
    gain = np.zeros((150, 150))
    gain[pairs.track, pairs.claim] = np.maximum(odds, 0.0)
    chosen = assign(pairs, odds, 150)
    rows, columns = linear_sum_assignment(gain, maximize=True)
    assert odds[chosen[chosen >= 0]].sum() == pytest.approx(gain[rows, columns].sum())


def test_nobody_gets_a_measurement_outside_the_gate():
    belief = belief_at(np.zeros((1, 2)), 0.01 * np.eye(4))
    measured = Measurements.cartesian([[5.0, 5.0]], 0.01 * np.eye(2))
    pairs, odds = odds_of(belief, measured)
    assert assign(pairs, odds, 1).tolist() == [-1]


def test_who_is_hardly_ever_detected_leaves_the_measurement_to_a_newcomer():
    belief = belief_at(np.zeros((1, 2)), 0.5 * np.eye(4))
    measured = Measurements.cartesian([[1.2, 0.8]], 0.05 * np.eye(2))
    config = CONFIG.replace(newcomer_density=0.1)
    for detection, expected in [(0.9, [0]), (0.05, [-1])]:
        pairs, odds = odds_of(belief, measured, detection, config)
        assert assign(pairs, odds, 1).tolist() == expected


def test_what_the_scan_shows_is_sooner_a_bystander_than_a_hand_is_a_newcomer_s():
    belief = belief_at(np.zeros((1, 2)), 4.0 * np.eye(4))
    config = CONFIG.replace(newcomer_density=0.005, bystander_density=0.05)
    odds = [
        odds_of(belief, Measurements.cartesian([[1, 1]], np.eye(2), raised=raised), 0.8, config)[1]
        for raised in (True, False)
    ]
    assert odds[0] - odds[1] == pytest.approx(np.log(10.0))


def test_no_tracks_or_no_measurements_are_no_trouble():
    measured = Measurements.cartesian([[0.0, 0.0]], np.eye(2))
    pairs, odds = odds_of(belief_at(np.zeros((0, 2)), np.eye(4)), measured)
    assert assign(pairs, odds, 0).tolist() == []
    pairs, odds = odds_of(belief_at(np.zeros((2, 2)), np.eye(4)), Measurements.none())
    assert assign(pairs, odds, 2).tolist() == [-1, -1]
