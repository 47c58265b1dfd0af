"""One person in each of many trials, every measurement known to be theirs: the filter alone."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray
from tracker.tracking.prediction.motion import Motion, carry
from tracker.tracking.sensing.claims import Claims
from tracker.tracking.update.correction import correct


def filter_trials(
    mean: FloatArray,
    covariance: FloatArray,
    values: FloatArray,
    claims: Claims,
    motion: Motion,
    outlier_dof: float,
) -> tuple[FloatArray, FloatArray]:
    """Predict and correct, frame by frame.

    Args:
        mean: Shape (B, 4), before the first frame.
        covariance: Shape (B, 4, 4).
        values: Shape (T, B, 2): bearing_rad and range_m.
        claims: B claims, but for their values.
        motion: Between frames.
        outlier_dof: Degrees of freedom of the ranges' Student-t noise; 0 is Gaussian.

    Returns:
        Means, shape (T, B, 4), and covariances, shape (T, B, 4, 4), after each measurement.
    """
    frames, trials, _ = values.shape
    means, covariances = np.empty((frames, trials, 4)), np.empty((frames, trials, 4, 4))
    now, spread = np.empty((1, trials, 4)), np.empty((1, trials, 4, 4))
    now[0], spread[0] = mean, covariance
    root = np.empty((4, 2))
    for frame in range(frames):
        measured = Claims(
            values[frame], claims.noise, claims.kind, claims.pose, claims.doubt, claims.raised,
            claims.body, claims.hand, claims.tag, claims.bias,
        )  # fmt: skip
        for trial in range(trials):
            carry(now, spread, 0, trial, motion, now, spread)
            correct(now, spread, 0, trial, measured, trial, outlier_dof, now, spread, trial, root)
        means[frame], covariances[frame] = now[0], spread[0]
    return means, covariances
