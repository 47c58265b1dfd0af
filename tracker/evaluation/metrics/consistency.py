"""Does the covariance match the error? NEES and NIS, and the bounds of their means."""

from __future__ import annotations

import numpy as np
from scipy.stats import chi2

from tracker.containers import FloatArray


def normalized_squared(error: FloatArray, covariance: FloatArray) -> FloatArray:
    """Normalize errors, e' inv(P) e: the NEES of estimates, the NIS of innovations.

    Args:
        error: Shape (..., D): truth minus estimate, or measured minus predicted.
        covariance: Shape (..., D, D): what the filter claims of that error.

    Returns:
        Shape (...). Where the claim is true: chi-square with D degrees of freedom.
    """
    solved = np.linalg.solve(covariance, error[..., None])[..., 0]
    return np.asarray((error * solved).sum(axis=-1))


def mean_bounds(dimensions: int, samples: int, probability: float = 0.95) -> tuple[float, float]:
    """Between which values the mean of independent NEES or NIS lies, if the filter is right.

    Args:
        dimensions: D, degrees of freedom of one sample.
        samples: How many the mean is of; they must be independent (one from each trial).
        probability: Of lying inside, half of the rest on either side.
    """
    tail = (1.0 - probability) / 2.0
    low, high = chi2.ppf([tail, 1.0 - tail], dimensions * samples) / samples
    return float(low), float(high)
