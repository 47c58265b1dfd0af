"""Which measurement belongs to which track? The most likely one-to-one assignment.

Every hypothesis has its likelihood, also that a track was missed and that a measurement comes from
nobody known; so all of them compare. The log-odds of a pair say how much likelier it is than its
track missed and its measurement somebody else's:

    log( Pd N(y; 0, S) ) - log( (1 - Pd) lambda ).
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from tracker.containers import FloatArray, IntArray
from tracker.tracking.gating import Pairs

#: Up to so many tracks or pairs, one dense assignment costs less than looking for clusters.
_DENSE_UP_TO = 40


def log_odds(pairs: Pairs, weight: FloatArray, detection_probability: FloatArray) -> FloatArray:
    """Log-odds of each pair against "missed, and somebody else's", shape (P,).

    Args:
        pairs: From `find_pairs`.
        weight: Shape (K, N): probability of each mode of motion.
        detection_probability: Shape (N,), in (0, 1): of each track, in this frame.
    """
    likelihood = pairs.log_likelihood[0]
    if len(weight) == 2:
        joint = pairs.log_likelihood + np.log(weight[:, pairs.track])
        likelihood = np.logaddexp(joint[0], joint[1])
    odds = np.log(detection_probability / (1.0 - detection_probability))
    return np.asarray(likelihood + odds[pairs.track] - pairs.log_newcomer)


def assign(pairs: Pairs, odds: FloatArray, tracks: int) -> IntArray:
    """Give each track at most one measurement, and back, at the highest sum of log-odds.

    The Hungarian algorithm (scipy's `linear_sum_assignment`); among many tracks, pairs without a
    rival are settled first, and the rest goes cluster by cluster.

    Args:
        pairs: P pairs.
        odds: Shape (P,), log-odds; a pair below 0 is not worth taking.
        tracks: N.

    Returns:
        Shape (N,): row of each track's pair, or -1.
    """
    chosen = np.full(tracks, -1, dtype=np.int64)
    rows = np.flatnonzero(odds > 0.0)
    if len(rows) == 0:
        return chosen
    track, claim = pairs.track[rows], pairs.claim[rows]
    claims = int(claim.max()) + 1
    if max(tracks, claims) <= _DENSE_UP_TO:
        _assign_densely(chosen, rows, track, claim, odds, (tracks, claims))
        return chosen
    alone = (np.bincount(track)[track] == 1) & (np.bincount(claim)[claim] == 1)
    chosen[track[alone]] = rows[alone]
    rows, track, claim = rows[~alone], track[~alone], claim[~alone]
    for part in _clusters(track, claim, tracks, claims):
        some_tracks, row = np.unique(track[part], return_inverse=True)
        some_claims, column = np.unique(claim[part], return_inverse=True)
        own = np.full(len(some_tracks), -1, dtype=np.int64)
        size = (len(some_tracks), len(some_claims))
        _assign_densely(own, rows[part], row, column, odds, size)
        chosen[some_tracks] = own
    return chosen


def _assign_densely(
    chosen: IntArray,
    rows: IntArray,
    track: IntArray,
    claim: IntArray,
    odds: FloatArray,
    size: tuple[int, int],
) -> None:
    gain = np.zeros(size)
    pair = np.full(size, -1, dtype=np.int64)
    gain[track, claim], pair[track, claim] = odds[rows], rows
    row, column = linear_sum_assignment(gain, maximize=True)
    chosen[row] = pair[row, column]


def _clusters(track: IntArray, claim: IntArray, tracks: int, claims: int) -> list[IntArray]:
    """Which pairs hang together through a track or a measurement, as rows of each cluster."""
    if len(track) <= _DENSE_UP_TO:
        return [np.arange(len(track))] if len(track) else []
    nodes = tracks + claims
    graph = coo_array((np.ones(len(track)), (track, tracks + claim)), shape=(nodes, nodes))
    cluster = connected_components(graph, directed=False)[1][track]
    order = np.argsort(cluster, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(cluster[order])) + 1)
