"""Whose is a measurement, and how probably?"""

from itertools import permutations, product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linear_sum_assignment

from tracker import Config, Measurements
from tracker.tracking.association.association import assign, associate, marginals
from tracker.tracking.association.gating import Pairs
from tracker.tracking.sensing.claims import claims_of
from tracker.tracking.settings import settings_of
from tracker.tracking.update.correction import correct_people

PLAIN = Config(motion="cv", outlier_dof=0.0, innovation_floor_m=0.0)


def pairs_with(track, claim, log_odds):
    """Pairs of which nothing but the odds is known."""
    order = np.lexsort([claim, track])
    track, claim, odds = (np.asarray(each)[order] for each in (track, claim, log_odds))
    nothing = np.zeros(len(track))
    return Pairs(track, claim, nothing[:, None], nothing, odds)


def gain_of(pairs, tracks, claims):
    """Shape (N, M): what each pair is worth."""
    gain = np.zeros((tracks, claims))
    gain[pairs.track, pairs.claim] = np.maximum(pairs.log_odds, 0.0)
    return gain


def random_pairs(rng, tracks, claims, share=1.0):
    track, claim = np.nonzero(rng.random((tracks, claims)) < share)
    return pairs_with(track, claim, rng.normal(1.0, 3.0, len(track)))


def assert_best(pairs, tracks, claims, best):
    chosen = assign(pairs, tracks, claims)
    taken = chosen[chosen >= 0]
    assert (pairs.track[taken] == np.flatnonzero(chosen >= 0)).all()
    assert len(set(pairs.claim[taken])) == len(taken)
    assert (pairs.log_odds[taken] > 0.0).all()
    assert pairs.log_odds[taken].sum() == pytest.approx(best)


@pytest.mark.parametrize(("tracks", "claims"), [(1, 3), (2, 2), (3, 2), (4, 4), (3, 4)])
def test_the_assignment_is_as_good_as_the_best_of_all(tracks, claims):
    rng = np.random.default_rng(tracks * 10 + claims)
    for _ in range(20):
        pairs = random_pairs(rng, tracks, claims)
        gain = gain_of(pairs, tracks, claims)

        def total(choice, gain=gain):
            return sum(gain[row, column] for row, column in enumerate(choice) if column >= 0)

        options = [*range(claims), *[-1] * tracks]
        best = max(total(choice) for choice in set(permutations(options, tracks)))
        assert_best(pairs, tracks, claims, best)


@given(
    seed=st.integers(0, 2**32 - 1),
    tracks=st.integers(1, 14),
    claims=st.integers(1, 14),
    share=st.floats(0.05, 1.0),
)
def test_pairs_in_several_clusters_are_assigned_at_the_highest_sum(seed, tracks, claims, share):
    pairs = random_pairs(np.random.default_rng(seed), tracks, claims, share)
    gain = gain_of(pairs, tracks, claims)
    best = gain[linear_sum_assignment(gain, maximize=True)].sum()
    assert_best(pairs, tracks, claims, best)


def test_equally_good_pairs_are_still_one_to_one():
    pairs = pairs_with(np.repeat([0, 1, 2], 2), np.tile([0, 1], 3), np.full(6, 2.0))
    assert_best(pairs, 3, 2, 4.0)


def test_a_crowd_is_assigned_as_one_dense_matrix_would_be(people_of, pairs_of):
    rng = np.random.default_rng(11)
    xy = rng.uniform(0, 12, (150, 2))
    people = people_of(np.pad(xy, ((0, 0), (0, 2))), np.diag([0.1, 0.1, 1.0, 1.0]))
    near = rng.permutation(xy) + rng.normal(scale=0.3, size=xy.shape)
    pairs = pairs_of(people, Measurements.cartesian(near, 0.05 * np.eye(2)), PLAIN)
    gain = gain_of(pairs, 150, 150)
    assert_best(pairs, 150, 150, gain[linear_sum_assignment(gain, maximize=True)].sum())


def test_a_measurement_that_is_sooner_somebody_else_s_is_nobody_s():
    assert assign(pairs_with([0, 1], [0, 1], [-0.1, 0.0]), 2, 2).tolist() == [-1, -1]


def test_who_is_hardly_ever_detected_leaves_the_measurement_to_a_newcomer(people_of, pairs_of):
    person = people_of(np.zeros((1, 4)), 0.5 * np.eye(4))
    measured = Measurements.cartesian([[1.2, 0.8]], 0.05 * np.eye(2))
    for chance, expected in [(0.9, [0]), (0.05, [-1])]:
        pairs = pairs_of(person, measured, PLAIN, chance=chance, density=0.1)
        assert assign(pairs, 1, 1).tolist() == expected


def test_no_tracks_or_no_measurements_are_no_trouble():
    none = pairs_with([], [], [])
    for tracks, claims in [(0, 0), (0, 2), (2, 0)]:
        assert assign(none, tracks, claims).tolist() == [-1] * tracks
        assert len(marginals(none, tracks, claims)) == 0


def exact(pairs, tracks, claims):
    """Probability of each pair, by the sum over every one-to-one hypothesis."""
    weight = np.zeros((tracks, claims))
    weight[pairs.track, pairs.claim] = np.exp(pairs.log_odds)
    total, each = 0.0, np.zeros((tracks, claims))
    for choice in product(range(-1, claims), repeat=tracks):
        taken = [column for column in choice if column >= 0]
        if len(set(taken)) < len(taken):
            continue
        chance = np.prod([weight[row, column] for row, column in enumerate(choice) if column >= 0])
        total += chance
        for row, column in enumerate(choice):
            if column >= 0:
                each[row, column] += chance
    return (each / total)[pairs.track, pairs.claim]


def test_without_a_loop_the_joint_probabilities_are_exact():
    rng = np.random.default_rng(1)
    for _ in range(20):  # a chain
        pairs = pairs_with([0, 0, 1, 1, 2], [0, 1, 1, 2, 2], rng.normal(scale=3.0, size=5))
        assert marginals(pairs, 3, 3) == pytest.approx(exact(pairs, 3, 3), abs=1e-7)


@pytest.mark.parametrize(("tracks", "claims"), [(2, 2), (3, 3), (4, 3), (3, 4)])
def test_with_loops_the_joint_probabilities_are_near(tracks, claims):
    # Williams and Lau's own comparison finds errors of a few hundredths where everything is in
    # doubt, as drawn here, and more in single cases of a short loop.
    rng = np.random.default_rng(tracks * 10 + claims)
    track, claim = (axis.ravel() for axis in np.indices((tracks, claims)))
    errors = []
    for _ in range(20):
        pairs = pairs_with(track, claim, rng.normal(scale=2.0, size=tracks * claims))
        found = marginals(pairs, tracks, claims)
        errors.append(np.abs(found - exact(pairs, tracks, claims)))
        assert (np.bincount(pairs.track, found) <= 1 + 1e-9).all()
        assert (np.bincount(pairs.claim, found) <= 1 + 1e-6).all()
    assert np.max(errors) < 0.25
    assert np.mean(errors) < 0.03


@given(seed=st.integers(0, 2**32 - 1), scale=st.sampled_from([1.0, 10.0, 1e3, 1e300]))
def test_whatever_the_odds_joint_probabilities_are_probabilities(seed, scale):
    rng = np.random.default_rng(seed)
    track, claim = np.nonzero(rng.random((5, 6)) < 0.6)
    pairs = pairs_with(track, claim, scale * rng.normal(size=len(track)))
    found = marginals(pairs, 5, 6)
    assert ((found >= 0.0) & (found <= 1.0)).all()
    assert (np.bincount(pairs.track, found, 5) <= 1 + 1e-9).all()


def associated(pairs, tracks, claims, association):
    settings = settings_of(PLAIN.replace(association=association))
    return associate(pairs, tracks, claims, settings)


def test_what_the_hungarian_algorithm_assigns_is_certain():
    pairs = random_pairs(np.random.default_rng(2), 6, 5, 0.6)
    chosen, probability = associated(pairs, 6, 5, "hungarian")
    assert chosen.tolist() == assign(pairs, 6, 5).tolist()
    expected = np.zeros(len(pairs.track))
    expected[chosen[chosen >= 0]] = 1.0
    assert probability.tolist() == expected.tolist()


def test_all_pairs_count_by_their_joint_probability():
    pairs = random_pairs(np.random.default_rng(3), 4, 4)
    chosen, probability = associated(pairs, 4, 4, "jpda")
    assert chosen.tolist() == assign(pairs, 4, 4).tolist()
    assert probability.tolist() == marginals(pairs, 4, 4).tolist()


def test_of_the_assigned_pair_alone_the_odds_say_how_probable_it_is():
    pairs = random_pairs(np.random.default_rng(4), 6, 5, 0.6)
    chosen, probability = associated(pairs, 6, 5, "pda")
    assert chosen.tolist() == assign(pairs, 6, 5).tolist()
    odds = np.exp(pairs.log_odds)
    is_taken = np.isin(np.arange(len(odds)), chosen)
    np.testing.assert_allclose(
        probability, np.where(is_taken, odds / (1.0 + odds), 0.0), rtol=1e-12
    )


def test_even_odds_are_one_in_two_and_huge_odds_certain():
    for log_odds, expected in [(1e-9, 0.5), (np.log(3.0), 0.75), (1e300, 1.0)]:
        _, probability = associated(pairs_with([0], [0], [log_odds]), 1, 1, "pda")
        assert probability == pytest.approx([expected])


def test_the_posterior_by_one_pair_mixes_the_prior_and_the_kalman_filter_s_update(
    people_of, pairs_of, corrected
):
    config = PLAIN.replace(association="pda", newcomer_density=0.2)
    mean, covariance = np.array([[1.0, 2.0, 0.1, 0.0]]), np.diag([0.2, 0.3, 0.5, 0.5])[None]
    covariance[0, 0, 2] = covariance[0, 2, 0] = 0.1
    measured = Measurements.polar([1.2, 1.0], [2.4, 2.0], 0.1, 0.2)
    people = people_of(mean, covariance)
    pairs = pairs_of(people, measured, config, chance=0.6)
    chosen, probability = associate(pairs, 1, 2, settings_of(config))
    correct_people(people, claims_of(measured), pairs, probability, 0.0)

    (pair,) = chosen
    odds = np.exp(pairs.log_odds[pair])
    p = odds / (1.0 + odds)
    assert 0.3 < p < 0.95
    moved, spread = corrected(mean, covariance, measured[[pairs.claim[pair]]])
    apart = moved[0] - mean[0]
    np.testing.assert_allclose(people.mean[0, 0], (1 - p) * mean[0] + p * moved[0], atol=1e-12)
    mixed = (1 - p) * covariance[0] + p * spread[0] + p * (1 - p) * np.outer(apart, apart)
    np.testing.assert_allclose(people.covariance[0, 0], mixed, atol=1e-12)
