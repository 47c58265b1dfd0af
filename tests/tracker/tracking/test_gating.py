import numpy as np
import pytest

from tracker import Config, Measurements
from tracker.tracking.filter import innovations
from tracker.tracking.gating import find_pairs, gate_limit
from tracker.tracking.modes import Belief

CONFIG = Config(motion="cv", outlier_dof=0.0, innovation_floor_m=0.0, gate_probability=0.99)


@pytest.fixture
def crowd():
    rng = np.random.default_rng(12)
    mean = np.concatenate([rng.uniform(-3, 3, (30, 2)), np.zeros((30, 2))], axis=1)
    root = rng.normal(scale=0.2, size=(30, 4, 4))
    covariance = root @ np.swapaxes(root, -1, -2) + 0.01 * np.eye(4)
    return Belief(np.ones((1, 30)), mean[None], covariance[None])


def mixed_claims(rng):
    """Of every kind, from sensors all over the place."""
    several = [
        Measurements.polar(
            rng.uniform(-3.1, 3.1, 6), rng.uniform(1, 5, 6), 0.05, 0.1, rng.uniform(-3, 3, 3)
        )
        for _ in range(4)
    ]
    alone = Measurements.polar(rng.uniform(-3, 3, 5), np.nan, 0.05, 0.1, (5.0, 5.0, -2.0))
    points = Measurements.cartesian(rng.uniform(-3, 3, (7, 2)), 0.02 * np.eye(2))
    return Measurements.concatenate(*several, alone, points)


def test_the_pairs_are_those_that_a_dense_gate_lets_through(crowd):
    claims = mixed_claims(np.random.default_rng(13))
    pairs = find_pairs(crowd, claims, CONFIG)
    innovation, spread = innovations(crowd.mean[0], crowd.covariance[0], claims)
    solved = np.linalg.solve(spread, innovation[..., None])[..., 0]
    distance = (innovation * solved).sum(axis=-1)
    limit = [gate_limit(not np.isnan(range_m), 0.99) for range_m in claims.values[:, 1]]
    expected = np.argwhere(distance <= limit)
    assert len(expected) > 20
    np.testing.assert_array_equal(np.stack([pairs.track, pairs.claim], axis=-1), expected)
    np.testing.assert_allclose(
        pairs.innovation[0], innovation[pairs.track, pairs.claim], atol=1e-12
    )


def test_the_order_of_measurements_changes_their_rows_and_nothing_else(crowd):
    rng = np.random.default_rng(14)
    claims = mixed_claims(rng)
    order = rng.permutation(len(claims))
    one, other = find_pairs(crowd, claims, CONFIG), find_pairs(crowd, claims[order], CONFIG)
    found = sorted(zip(other.track, order[other.claim], strict=True))
    assert found == sorted(zip(one.track, one.claim, strict=True))


def test_the_floor_widens_the_gate_of_an_over_confident_track():
    belief = Belief(np.ones((1, 1)), np.zeros((1, 1, 4)), 1e-8 * np.eye(4)[None, None])
    claims = Measurements.cartesian([[0.1, 0.0]], 1e-8 * np.eye(2))
    assert len(find_pairs(belief, claims, CONFIG)) == 0
    assert len(find_pairs(belief, claims, CONFIG.replace(innovation_floor_m=0.05))) == 1


def test_a_heavy_tail_widens_the_gate_in_range_alone():
    mean = np.array([3.0, 0.0, 0.0, 0.0])
    belief = Belief(np.ones((1, 1)), mean[None, None], 1e-4 * np.eye(4)[None, None])
    tailed = CONFIG.replace(outlier_dof=4.0)
    behind = Measurements.polar(0.0, 3.4, 0.02, 0.1)
    beside = Measurements.polar(0.08, 3.0, 0.02, 0.1)
    assert [len(find_pairs(belief, behind, config)) for config in (CONFIG, tailed)] == [0, 1]
    assert [len(find_pairs(belief, beside, config)) for config in (CONFIG, tailed)] == [0, 0]
