"""Does somebody stand or walk? The interacting multiple model (IMM) estimator.

Every track carries one Gaussian for each mode of motion, and the probability of each. The axis
of the modes comes first in every array, so that all tracks in one mode lie side by side. One mode
alone is the plain Kalman filter.

Source: Blom and Bar-Shalom, "The Interacting Multiple Model Algorithm for Systems with Markovian
Switching Coefficients", IEEE Transactions on Automatic Control 33(8), 1988.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tracker.containers import FloatArray
from tracker.tracking.motion import Motion, carry


@dataclass(frozen=True, slots=True, eq=False)
class Belief:
    """Where N people are, in each of K modes of motion (one or two).

    Attributes:
        weight: Shape (K, N): probability of each mode, adding up to 1.
        mean: Shape (K, N, 4): x_m, y_m, vx_mps, vy_mps in the fixed frame.
        covariance: Shape (K, N, 4, 4).
        known: What `merged` returns, where it has been computed already.
    """

    weight: FloatArray
    mean: FloatArray
    covariance: FloatArray
    known: tuple[FloatArray, FloatArray] | None = None

    def __getitem__(self, rows: Any) -> Belief:
        return Belief(self.weight[:, rows], self.mean[:, rows], self.covariance[:, rows])

    @staticmethod
    def begin(
        mean: FloatArray, covariance: FloatArray, modes: int, stand_speed_std_mps: float
    ) -> Belief:
        """Somebody new, as likely to walk as to stand; who stands hardly moves.

        Args:
            mean: Shape (N, 4).
            covariance: Shape (N, 4, 4).
            modes: K.
            stand_speed_std_mps: Spread of the speed of those who stand, per axis.
        """
        weight = np.full((modes, len(mean)), 1.0 / modes)
        means = np.repeat(mean[None], modes, axis=0)
        covariances = np.repeat(covariance[None], modes, axis=0)
        if modes == 2:
            covariances[1, :, [2, 3], [2, 3]] = stand_speed_std_mps**2
        return Belief(weight, means, covariances)

    def append(self, other: Belief) -> Belief:
        """Rows of both, in order."""
        return Belief(
            np.concatenate([self.weight, other.weight], axis=1),
            np.concatenate([self.mean, other.mean], axis=1),
            np.concatenate([self.covariance, other.covariance], axis=1),
        )

    def merged(self) -> tuple[FloatArray, FloatArray]:
        """The one Gaussian with the same first two moments, (N, 4) and (N, 4, 4)."""
        if self.known is not None:
            return self.known
        if len(self.weight) == 1:
            return self.mean[0], self.covariance[0]
        mean, covariance = _mixed(self.weight[:, None], self.mean, self.covariance)
        return mean[0], covariance[0]

    def with_modes(self, modes: int, stand_speed_std_mps: float) -> Belief:
        """The same people under another number of modes."""
        if modes == len(self.weight):
            return self
        return Belief.begin(*self.merged(), modes, stand_speed_std_mps)


def predict_modes(belief: Belief, motion: Motion) -> Belief:
    """Mix the modes by how people change between them, then carry each over the interval.

    Args:
        belief: Posterior of the last frame.
        motion: What the interval does.
    """
    weight, mean, covariance = belief.weight, belief.mean, belief.covariance
    if motion.modes == 2:
        joint = motion.switching[:, :, None] * weight[:, None]  # from i to j
        weight = joint.sum(axis=0)
        mean, covariance = _mixed(joint / np.maximum(weight, 1e-300), mean, covariance)
    return Belief(weight, *carry(mean, covariance, motion))


def weigh_modes(weight: FloatArray, log_likelihood: FloatArray) -> FloatArray:
    """Bayes' rule on the modes of N tracks.

    Args:
        weight: Shape (K, N), before.
        log_likelihood: Shape (K, N), of what was measured under each mode.

    Returns:
        Shape (K, N), adding up to 1 over the modes.
    """
    if len(weight) == 1:
        return weight
    scaled = weight * np.exp(log_likelihood - log_likelihood.max(axis=0))
    # No mode is ever excluded for good: people do change over.
    scaled = np.maximum(scaled / scaled.sum(axis=0), 1e-12)
    return np.asarray(scaled / scaled.sum(axis=0))


def _mixed(
    share: FloatArray, mean: FloatArray, covariance: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Moments of mixtures of two Gaussians.

    The spread of the means is the product of the shares times the squared difference: nothing
    cancels, however far from the origin people are.

    Args:
        share: Shape (2, J, N): of each mode in each of J mixtures.
        mean: Shape (2, N, 4).
        covariance: Shape (2, N, 4, 4).

    Returns:
        Shapes (J, N, 4) and (J, N, 4, 4).
    """
    apart = mean[1] - mean[0]
    second = share[1][..., None]
    mixed_mean = mean[0] + second * apart
    outer = apart[:, :, None] * apart[:, None, :]
    first = share[0][..., None, None]
    second = second[..., None]
    mixed = first * covariance[0] + second * covariance[1] + (first * second) * outer
    return mixed_mean, mixed
