import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

pytest.importorskip("numba", reason="numba (the extra fast) is not installed")


@pytest.fixture(scope="module")
def assign_pairs():
    """Loops are called by compiled functions alone."""
    from numba import njit

    from tracker.tracking.compiled import association

    @njit
    def call(track, claim, odds, tracks, claims):
        return association.assign_pairs(track, claim, odds, tracks, claims)

    return call


@pytest.mark.parametrize("seed", range(30))
def test_pairs_in_several_clusters_are_assigned_at_the_highest_sum(assign_pairs, seed):
    rng = np.random.default_rng(seed)
    tracks, claims = rng.integers(1, 12, 2)
    is_pair = rng.random((tracks, claims)) < rng.uniform(0.1, 0.9)
    track, claim = np.nonzero(is_pair)
    odds = rng.normal(1.0, 3.0, len(track))
    chosen = assign_pairs(track, claim, odds, tracks, claims)

    gain = np.zeros((tracks, claims))
    gain[track, claim] = np.maximum(odds, 0.0)
    best = gain[linear_sum_assignment(gain, maximize=True)].sum()
    taken = chosen[chosen >= 0]
    assert (track[taken] == np.flatnonzero(chosen >= 0)).all()
    assert len(set(claim[taken])) == len(taken)
    assert (odds[taken] > 0.0).all()
    assert odds[taken].sum() == pytest.approx(best)
