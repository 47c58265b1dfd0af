"""What do measurements make of tracks? The posterior, by assignment or by probabilities."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray, IntArray
from tracker.tracking.filter import correct
from tracker.tracking.gating import Pairs
from tracker.tracking.modes import Belief, weigh_modes

#: A mode explains a measurement no more than e^50 times better than the modes on average.
LOG_RATIO_MAX = 50.0


def update_assigned(belief: Belief, pairs: Pairs) -> Belief:
    """Posterior of tracks with one measurement each; the others stay as predicted.

    Args:
        belief: N tracks, predicted.
        pairs: One pair for each track that has a measurement, by track.
    """
    if len(pairs) == 0:
        return belief
    rows: IntArray | slice = pairs.track
    if len(pairs) == belief.weight.shape[1]:
        rows = slice(None)  # everybody, in order
    mean, covariance = correct(
        belief.mean[:, rows],
        belief.covariance[:, rows],
        pairs.innovation,
        pairs.jacobian,
        pairs.noise,
    )
    weight = weigh_modes(belief.weight[:, rows], pairs.log_likelihood)
    if isinstance(rows, slice):
        return Belief(weight, mean, covariance)
    weights, means = belief.weight.copy(), belief.mean.copy()
    covariances = belief.covariance.copy()
    weights[:, rows], means[:, rows], covariances[:, rows] = weight, mean, covariance
    return Belief(weights, means, covariances)


def update_jointly(belief: Belief, pairs: Pairs, probability: FloatArray) -> Belief:
    """Posterior of each track as one Gaussian a mode, over all its pairs and "missed".

    The covariance holds the spread between the hypotheses. A mode that explains the measurements
    better gains weight, and believes its own pairs more.

    Args:
        belief: N tracks, predicted.
        pairs: P pairs, by track; their noise already knows of outliers.
        probability: Shape (P,), from `marginals`.
    """
    if len(pairs) == 0:
        return belief
    track = pairs.track
    likelihood = pairs.log_likelihood + np.log(belief.weight[:, track])
    likelihood = pairs.log_likelihood - np.logaddexp.reduce(likelihood, axis=0)
    share = probability * np.exp(np.minimum(likelihood, LOG_RATIO_MAX))  # (K, P)
    begins = np.flatnonzero(np.diff(track, prepend=-1))
    touched = track[begins]
    missed = np.maximum(1.0 - np.add.reduceat(probability, begins), 0.0)
    total = missed + np.add.reduceat(share, begins, axis=1)  # (K, touched)
    total = np.maximum(total, 1e-300)
    group = np.cumsum(np.diff(track, prepend=track[0]) > 0)
    share = share / total[:, group]
    stay = missed / total

    prior_mean, prior_covariance = belief.mean[:, touched], belief.covariance[:, touched]
    mean, covariance = correct(
        belief.mean[:, track],
        belief.covariance[:, track],
        pairs.innovation,
        pairs.jacobian,
        pairs.noise,
    )
    # Differences to the prior, so that nothing cancels far from the origin.
    moved = mean - prior_mean[:, group]
    shift = np.add.reduceat(share[..., None] * moved, begins, axis=1)
    apart = moved - shift[:, group]
    spread = covariance + apart[..., :, None] * apart[..., None, :]
    merged = np.add.reduceat(share[..., None, None] * spread, begins, axis=1)
    merged += stay[..., None, None] * (
        prior_covariance + shift[..., :, None] * shift[..., None, :]
    )

    weights, means = belief.weight.copy(), belief.mean.copy()
    covariances = belief.covariance.copy()
    weights[:, touched] = weigh_modes(belief.weight[:, touched], np.log(total))
    means[:, touched], covariances[:, touched] = prior_mean + shift, merged
    return Belief(weights, means, covariances)
