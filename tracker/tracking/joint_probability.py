"""How probable is each pair, over all joint hypotheses? Joint probabilistic data association.

Counting all hypotheses takes exponential time; loopy belief propagation on the same graph takes a
few sweeps over the list of pairs, always converges, and is exact where the pairs form no loop.

Source: Williams and Lau, "Approximate Evaluation of Marginal Association Probabilities with Belief
Propagation", IEEE Transactions on Aerospace and Electronic Systems 50(4), 2014.
"""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray, IntArray

#: Sweeps end once no message changes by more, or after so many: then the answer is still a
#: probability, only not the best one.
CHANGE_MIN = 1e-9
SWEEPS_MAX = 200
#: Beyond, a pair is certain; sums over the other pairs would drown in rounding errors.
LOG_ODDS_MAX = 20.0


def marginals(track: IntArray, claim: IntArray, odds: FloatArray) -> FloatArray:
    """Probability of each pair, over all one-to-one hypotheses.

    Args:
        track: Shape (P,): row of the track.
        claim: Shape (P,): row of the measurement.
        odds: Shape (P,): log-odds of the pair against "missed, and somebody else's".

    Returns:
        Shape (P,); what they lack to 1 for a track is the probability that it was missed.
    """
    if len(track) == 0:
        return np.zeros(0)
    weight = np.exp(np.minimum(odds, LOG_ODDS_MAX))
    to_track = np.ones(len(weight))
    for _ in range(SWEEPS_MAX):
        told = weight * to_track
        to_claim = weight / (1.0 + _others(track, told))
        message = 1.0 / (1.0 + _others(claim, to_claim))
        change = np.abs(message - to_track).max()
        to_track = message
        if change < CHANGE_MIN:
            break
    told = weight * to_track
    return np.asarray(told / (1.0 + np.bincount(track, told)[track]))


def _others(group: IntArray, values: FloatArray) -> FloatArray:
    """For each pair, the sum over the other pairs of its group."""
    return np.asarray(np.maximum(np.bincount(group, values)[group] - values, 0.0))
