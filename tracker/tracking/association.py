"""Which measurement belongs to which track? Gate, then the best one-to-one assignment."""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.stats import chi2

from tracker.containers import BoolArray, FloatArray, IntArray, Measurements

#: A missed detection costs as much as a measurement at the edge of the gate whose track knew its
#: place so badly that the innovation spreads e^4 times wider than the sensor's noise. Finite, so
#: that hypotheses with and without it stay comparable.
_MISSED_LOG_SPREAD = 8.0


def squared_distances(innovation: FloatArray, spread: FloatArray) -> FloatArray:
    """Squared Mahalanobis distances y' inv(S) y, shape (N, M), of innovations (N, M, 2)."""
    solved = np.linalg.solve(spread, innovation[..., None])[..., 0]
    return np.asarray(np.einsum("nmi,nmi->nm", innovation, solved))


def gate(
    distances: FloatArray, measurements: Measurements, gate_probability: float
) -> tuple[BoolArray, FloatArray]:
    """Mark the pairs close enough to be worth associating.

    A pair passes when its squared distance does not exceed the chi-square quantile of
    `gate_probability`, with one degree of freedom for a bearing alone and two otherwise.

    Args:
        distances: Shape (N, M), squared Mahalanobis distances.
        measurements: The M claims.
        gate_probability: Share of true measurements to keep.

    Returns:
        Mask of shape (N, M) and the limit of each measurement, shape (M,).
    """
    freedom = np.where(np.isnan(measurements.values[:, 1]), 1, 2)
    limit = np.asarray(chi2.ppf(gate_probability, [1, 2]))[freedom - 1]
    return distances <= limit, limit


def associate(
    innovation: FloatArray,
    spread: FloatArray,
    measurements: Measurements,
    gate_probability: float,
) -> IntArray:
    """Assign at most one measurement to each track, at the highest joint likelihood.

    The cost of a pair is y' inv(S) y + log(|S| / |R|): twice its negative log-likelihood, in units
    in which bearings, ranges and positions compare. Leaving a track without measurement costs the
    gate's limit and a constant more (Hungarian algorithm, scipy's `linear_sum_assignment`).

    Args:
        innovation: Shape (N, M, 2), from `filter.innovations`.
        spread: Shape (N, M, 2, 2), S of each pair.
        measurements: The M claims.
        gate_probability: Share of true measurements that the gate keeps.

    Returns:
        Shape (N,): row of each track's measurement, or -1.
    """
    tracks, claims = innovation.shape[:2]
    chosen = np.full(tracks, -1, dtype=np.int64)
    if tracks == 0 or claims == 0:
        return chosen
    distances = squared_distances(innovation, spread)
    inside, limit = gate(distances, measurements, gate_probability)
    noise = np.linalg.slogdet(measurements.covariance)[1]
    cost = distances + np.linalg.slogdet(spread)[1] - noise
    gain = np.where(inside, cost - (limit + _MISSED_LOG_SPREAD), 0.0)
    rows, columns = linear_sum_assignment(np.minimum(gain, 0.0))
    taken = gain[rows, columns] < 0.0
    chosen[rows[taken]] = columns[taken]
    return chosen
