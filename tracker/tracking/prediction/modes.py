"""Does somebody stand or walk? The interacting multiple model (IMM) estimator.

Every track carries one Gaussian for each mode of motion (one mode, or two: walk and stand) and the
probability of each. One mode alone is the plain Kalman filter.

Source: Blom and Bar-Shalom, "The Interacting Multiple Model Algorithm for Systems with Markovian
Switching Coefficients", IEEE Transactions on Automatic Control 33(8), 1988.
"""

from __future__ import annotations

import numpy as np

from tracker.compiling.loops import loop, step
from tracker.containers import FloatArray

#: No mode is ever excluded for good: people do change over.
WEIGHT_MIN = 1e-12


@loop
def mix(
    first: float,
    second: float,
    mean: FloatArray,
    covariance: FloatArray,
    person: int,
    mixed_mean: FloatArray,
    mixed: FloatArray,
) -> None:
    """Moments of the mixture of somebody's two Gaussians, written to their row of the last two.

        m = m1 + w2 (m2 - m1),    P = w1 P1 + w2 P2 + w1 w2 (m2 - m1) (m2 - m1)'

    Nothing cancels, however far from the origin people are.

    Args:
        first: Weight of the first one, w1.
        second: Weight of the second one, w2.
        mean: Shape (2, N, 4).
        covariance: Shape (2, N, 4, 4).
        person: Their row.
        mixed_mean: Shape (N, 4).
        mixed: Shape (N, 4, 4).
    """
    for row in range(4):
        apart = mean[1, person, row] - mean[0, person, row]
        mixed_mean[person, row] = mean[0, person, row] + second * apart
        for column in range(4):
            outer = apart * (mean[1, person, column] - mean[0, person, column])
            mixed[person, row, column] = (
                first * covariance[0, person, row, column]
                + second * covariance[1, person, row, column]
                + first * second * outer
            )


@loop
def merge_modes(
    weight: FloatArray,
    mean: FloatArray,
    covariance: FloatArray,
    merged_mean: FloatArray,
    merged: FloatArray,
) -> None:
    """The one Gaussian of each person with the first two moments of their modes.

    Args:
        weight: Shape (K, N).
        mean: Shape (K, N, 4).
        covariance: Shape (K, N, 4, 4).
        merged_mean: Shape (N, 4), to be written.
        merged: Shape (N, 4, 4), to be written.
    """
    for person in range(weight.shape[1]):
        if len(weight) == 2:
            first, second = weight[0, person], weight[1, person]
            mix(first, second, mean, covariance, person, merged_mean, merged)
            continue
        for row in range(4):
            merged_mean[person, row] = mean[0, person, row]
            for column in range(4):
                merged[person, row, column] = covariance[0, person, row, column]


@step
def weigh_modes(weight: FloatArray, person: int, log_likelihood: FloatArray) -> None:
    """Bayes' rule on the modes of one track, in place.

    Args:
        weight: Shape (K, N).
        person: Their row.
        log_likelihood: Shape (K,), of what was measured under each mode.
    """
    modes = len(weight)
    if modes == 2:
        most, total = max(log_likelihood[0], log_likelihood[1]), 0.0
        for mode in range(modes):
            weight[mode, person] *= np.exp(log_likelihood[mode] - most)
            total += weight[mode, person]
        floored = 0.0
        for mode in range(modes):
            weight[mode, person] = max(weight[mode, person] / total, WEIGHT_MIN)
            floored += weight[mode, person]
        for mode in range(modes):
            weight[mode, person] /= floored
