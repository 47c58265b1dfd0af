from itertools import product

import numpy as np
import pytest

from tracker import Config, Measurements
from tracker.tracking.gating import find_pairs
from tracker.tracking.joint_probability import marginals
from tracker.tracking.modes import Belief
from tracker.tracking.posterior import update_jointly


def exact(tracks, claims, track, claim, odds):
    """Sum over every one-to-one hypothesis."""
    weight = np.zeros((tracks, claims))
    weight[track, claim] = np.exp(odds)
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
    return (each / total)[track, claim]


def test_without_a_loop_the_probabilities_are_exact():
    rng = np.random.default_rng(1)
    track, claim = np.array([0, 0, 1, 1, 2]), np.array([0, 1, 1, 2, 2])  # a chain
    for _ in range(20):
        odds = rng.normal(scale=3.0, size=5)
        expected = exact(3, 3, track, claim, odds)
        assert marginals(track, claim, odds) == pytest.approx(expected, abs=1e-7)


@pytest.mark.parametrize(("tracks", "claims"), [(2, 2), (3, 3), (4, 3), (3, 4)])
def test_with_loops_the_probabilities_are_near(tracks, claims):
    # Williams and Lau's own comparison finds errors of a few hundredths where everything is in
    # doubt, as drawn here, and more in single cases of a short loop.
    rng = np.random.default_rng(tracks * 10 + claims)
    track, claim = (axis.ravel() for axis in np.indices((tracks, claims)))
    errors = []
    for _ in range(20):
        odds = rng.normal(scale=2.0, size=tracks * claims)
        found = marginals(track, claim, odds)
        errors.append(np.abs(found - exact(tracks, claims, track, claim, odds)))
        assert (np.bincount(track, found) <= 1 + 1e-9).all()
        assert (np.bincount(claim, found) <= 1 + 1e-6).all()
    assert np.max(errors) < 0.25
    assert np.mean(errors) < 0.03


def test_one_track_is_the_pda_filter():
    config = Config(motion="cv", outlier_dof=0.0, innovation_floor_m=0.0)
    mean, covariance = np.array([1.0, 2.0, 0.1, 0.0]), np.diag([0.2, 0.3, 0.5, 0.5])
    belief = Belief(np.ones((1, 1)), mean[None, None], covariance[None, None])
    noise = 0.05 * np.eye(2)
    claims = Measurements.cartesian([[1.3, 2.1], [0.8, 1.6]], noise)
    pairs = find_pairs(belief, claims, config)
    share = np.array([0.5, 0.3])
    found = update_jointly(belief, pairs, share)

    observe = np.eye(2, 4)
    spread = observe @ covariance @ observe.T + noise
    gain = covariance @ observe.T @ np.linalg.inv(spread)
    each = claims.values - mean[:2]
    together = share @ each
    np.testing.assert_allclose(found.mean[0, 0], mean + gain @ together, atol=1e-12)
    between = (share[:, None, None] * each[:, :, None] * each[:, None]).sum(0)
    between -= np.outer(together, together)
    expected = covariance - 0.8 * gain @ spread @ gain.T + gain @ between @ gain.T
    np.testing.assert_allclose(found.covariance[0, 0], expected, atol=1e-12)


def test_nothing_measured_is_nothing_probable():
    none = np.zeros(0, dtype=np.int64)
    assert len(marginals(none, none, np.zeros(0))) == 0
