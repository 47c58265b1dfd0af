"""What do measurements make of tracks? `posterior`, track by track."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray, IntArray
from tracker.tracking.compiled.loop import loop, step
from tracker.tracking.compiled.pairing import (
    H00,
    H01,
    H10,
    H11,
    LOG_LIKELIHOOD,
    R00,
    R01,
    R11,
    Y0,
    Y1,
    log_of_sum,
)
from tracker.tracking.filter import NOISE_SHARE_MIN
from tracker.tracking.posterior import LOG_RATIO_MAX


@loop
def update_assigned(
    weight: FloatArray,
    mean: FloatArray,
    covariance: FloatArray,
    chosen: IntArray,
    numbers: FloatArray,
) -> None:
    """Correct each track with its one pair, in place: `posterior.update_assigned`."""
    modes = len(weight)
    likelihood, root = np.empty(modes), np.empty((4, 2))
    for person in range(len(chosen)):
        pair = chosen[person]
        if pair < 0:
            continue
        for mode in range(modes):
            likelihood[mode] = numbers[pair, mode, LOG_LIKELIHOOD]
            _correct(mean, covariance, mode, person, numbers, pair, mean, covariance, person, root)
        _weigh(weight, person, likelihood)


@loop
def update_jointly(
    weight: FloatArray,
    mean: FloatArray,
    covariance: FloatArray,
    track: IntArray,
    numbers: FloatArray,
    probability: FloatArray,
) -> None:
    """Correct each track with all its pairs, in place: `posterior.update_jointly`."""
    pairs, modes = len(track), len(weight)
    share, total = np.empty((modes, pairs)), np.empty(modes)
    moved, spread = np.empty((modes, pairs, 4)), np.empty((modes, pairs, 4, 4))
    shift, root = np.empty(4), np.empty((4, 2))
    begin = 0
    while begin < pairs:
        person, end = track[begin], begin + 1
        while end < pairs and track[end] == person:
            end += 1
        missed = 1.0
        for pair in range(begin, end):
            missed -= probability[pair]
            both = -np.inf
            for mode in range(modes):
                joint = numbers[pair, mode, LOG_LIKELIHOOD] + np.log(weight[mode, person])
                both = log_of_sum(both, joint)
            for mode in range(modes):
                ratio = numbers[pair, mode, LOG_LIKELIHOOD] - both
                share[mode, pair] = probability[pair] * np.exp(min(ratio, LOG_RATIO_MAX))
        missed = max(missed, 0.0)
        for mode in range(modes):
            total[mode] = missed
            for pair in range(begin, end):
                total[mode] += share[mode, pair]
            total[mode] = max(total[mode], 1e-300)
            shift[:] = 0.0
            for pair in range(begin, end):
                share[mode, pair] /= total[mode]
                _correct(mean, covariance, mode, person, numbers, pair, moved, spread, pair, root)
                for row in range(4):
                    moved[mode, pair, row] -= mean[mode, person, row]
                    shift[row] += share[mode, pair] * moved[mode, pair, row]
            stay = missed / total[mode]
            for row in range(4):
                for column in range(4):
                    own = covariance[mode, person, row, column]
                    merged = stay * (own + shift[row] * shift[column])
                    for pair in range(begin, end):
                        apart = moved[mode, pair, row] - shift[row]
                        outer = apart * (moved[mode, pair, column] - shift[column])
                        merged += share[mode, pair] * (spread[mode, pair, row, column] + outer)
                    covariance[mode, person, row, column] = merged
                mean[mode, person, row] += shift[row]
            total[mode] = np.log(total[mode])
        _weigh(weight, person, total)
        begin = end


@step
def _weigh(weight: FloatArray, person: int, log_likelihood: FloatArray) -> None:
    """Bayes' rule on the modes of one track, in place: `modes.weigh_modes`."""
    modes = len(weight)
    if modes == 1:
        return
    most, total = log_likelihood.max(), 0.0
    for mode in range(modes):
        weight[mode, person] *= np.exp(log_likelihood[mode] - most)
        total += weight[mode, person]
    floored = 0.0
    for mode in range(modes):
        weight[mode, person] = max(weight[mode, person] / total, 1e-12)
        floored += weight[mode, person]
    for mode in range(modes):
        weight[mode, person] /= floored


@step
def _correct(
    mean: FloatArray,
    covariance: FloatArray,
    mode: int,
    person: int,
    numbers: FloatArray,
    pair: int,
    new_mean: FloatArray,
    new: FloatArray,
    to: int,
    root: FloatArray,
) -> None:
    """Mean x + K y and P - K S K' of one track in one mode: `filter.correct`.

    What is new goes to a row of the arrays named so, and may take the place of what was; `root`,
    shape (4, 2), is room to work in.
    """
    h00, h01 = numbers[pair, mode, H00], numbers[pair, mode, H01]
    h10, h11 = numbers[pair, mode, H10], numbers[pair, mode, H11]
    r00, r01, r11 = numbers[pair, mode, R00], numbers[pair, mode, R01], numbers[pair, mode, R11]
    p00, p01 = covariance[mode, person, 0, 0], covariance[mode, person, 0, 1]
    p11 = covariance[mode, person, 1, 1]
    x0, y0 = p00 * h00 + p01 * h01, p01 * h00 + p11 * h01
    x1, y1 = p00 * h10 + p01 * h11, p01 * h10 + p11 * h11
    own00, own01, own11 = h00 * x0 + h01 * y0, h00 * x1 + h01 * y1, h10 * x1 + h11 * y1
    l00 = np.sqrt(own00 + max(r00, NOISE_SHARE_MIN * own00))
    l10 = (own01 + r01) / l00
    l11 = np.sqrt(own11 + max(r11, NOISE_SHARE_MIN * own11) - l10 * l10)
    per_l00, per_l11 = 1.0 / l00, 1.0 / l11
    first = numbers[pair, mode, Y0] * per_l00
    second = (numbers[pair, mode, Y1] - l10 * first) * per_l11
    for row in range(4):
        to_x, to_y = covariance[mode, person, row, 0], covariance[mode, person, row, 1]
        root[row, 0] = (to_x * h00 + to_y * h01) * per_l00
        root[row, 1] = (to_x * h10 + to_y * h11 - l10 * root[row, 0]) * per_l11
    for row in range(4):
        new_mean[mode, to, row] = (
            mean[mode, person, row] + root[row, 0] * first + root[row, 1] * second
        )
        for column in range(row + 1):
            here = covariance[mode, person, row, column]
            mirrored = covariance[mode, person, column, row]
            taken = root[row, 0] * root[column, 0] + root[row, 1] * root[column, 1]
            rest = (here + mirrored) * 0.5 - taken
            new[mode, to, row, column] = new[mode, to, column, row] = rest
