"""How do measurements correct a track? The extended Kalman filter over all its hypotheses.

A bearing and a range are compared where they were taken, in the sensor's frame, so that a wide
bearing error at a long range does not have to pass for a Gaussian in x and y.
"""

from __future__ import annotations

import numpy as np

from tracker.compiling.loops import maker, step
from tracker.containers import FloatArray
from tracker.tracking.association.gating import Pairs, log_of_sum
from tracker.tracking.people import People
from tracker.tracking.prediction.modes import weigh_modes
from tracker.tracking.sensing.claims import Claims
from tracker.tracking.sensing.innovation import innovation_of, noise_of, seen_from
from tracker.tracking.sensing.sensor_kinds import BEARING, POSITION
from tracker.tracking.update.outliers import outlier_variance

#: A measurement's variance counts for at least this share of what the track itself contributes to
#: the innovation: beyond it the posterior would drown in rounding errors.
NOISE_SHARE_MIN = 1e-9
#: A mode explains a measurement no more than e^50 times better than the modes on average.
LOG_RATIO_MAX = 50.0


@maker
def correct_people(
    people: People, claims: Claims, pairs: Pairs, probability: FloatArray, dof: float
) -> None:
    """Posterior of everybody over all pairs and "missed", in place.

    Args:
        people: N tracks, predicted.
        claims: M claims.
        pairs: P pairs, by track.
        probability: Shape (P,): what it lacks to 1 for a track is the chance that it was missed.
        dof: Degrees of freedom of the ranges' Student-t noise; 0 is Gaussian.
    """
    begin = 0
    while begin < len(pairs.track):
        end = begin + 1
        while end < len(pairs.track) and pairs.track[end] == pairs.track[begin]:
            end += 1
        _correct_person(people, claims, pairs, probability, begin, end, dof)
        begin = end


@maker
def _correct_person(
    people: People,
    claims: Claims,
    pairs: Pairs,
    probability: FloatArray,
    begin: int,
    end: int,
    dof: float,
) -> None:
    """The pairs of one track: one Gaussian a mode, with the spread between the hypotheses.

    A mode that explains the measurements better gains weight, and believes its own pairs more.
    """
    modes, person = len(people.weight), pairs.track[begin]
    total, share = np.empty(modes), np.empty((modes, end - begin))
    missed = 1.0
    for pair in range(begin, end):
        missed -= probability[pair]
        both = pairs.log_likelihood[pair, 0]
        if modes == 2:
            both = log_of_sum(
                both + np.log(people.weight[0, person]),
                pairs.log_likelihood[pair, 1] + np.log(people.weight[1, person]),
            )
        for mode in range(modes):
            ratio = min(pairs.log_likelihood[pair, mode] - both, LOG_RATIO_MAX)
            share[mode, pair - begin] = probability[pair] * np.exp(ratio)
    missed = max(missed, 0.0)
    for mode in range(modes):
        total[mode] = missed
        for number in range(end - begin):
            total[mode] += share[mode, number]
        total[mode] = max(total[mode], 1e-300)
        for number in range(end - begin):
            share[mode, number] /= total[mode]
        _mix_hypotheses(
            people, mode, person, claims, pairs, begin, share, missed / total[mode], dof
        )
        total[mode] = np.log(total[mode])
    weigh_modes(people.weight, person, total)


@maker
def _mix_hypotheses(
    people: People,
    mode: int,
    person: int,
    claims: Claims,
    pairs: Pairs,
    begin: int,
    share: FloatArray,
    stay: float,
    dof: float,
) -> None:
    """One track in one mode: the mixture of its posteriors by each pair, and of its prior.

    Differences to the prior are mixed, so that nothing cancels far from the origin.
    """
    mean, covariance = people.mean, people.covariance
    count = share.shape[1]
    moved, spread = np.empty((1, count, 4)), np.empty((1, count, 4, 4))
    shift, root = np.empty(4), np.empty((4, 2))
    for row in range(4):
        shift[row] = 0.0
    used = 0
    for number in range(count):
        if share[mode, number] == 0.0:
            continue
        claim = pairs.claim[begin + number]
        correct(mean, covariance, mode, person, claims, claim, dof, moved, spread, number, root)
        used += 1
        for row in range(4):
            moved[0, number, row] -= mean[mode, person, row]
            shift[row] += share[mode, number] * moved[0, number, row]
    if used == 0:
        return
    for row in range(4):
        for column in range(4):
            own = covariance[mode, person, row, column]
            merged = stay * (own + shift[row] * shift[column])
            for number in range(count):
                if share[mode, number] > 0.0:
                    apart = moved[0, number, row] - shift[row]
                    outer = apart * (moved[0, number, column] - shift[column])
                    merged += share[mode, number] * (spread[0, number, row, column] + outer)
            covariance[mode, person, row, column] = merged
        mean[mode, person, row] += shift[row]


@maker
def correct_by(people: People, person: int, claims: Claims, row: int, dof: float) -> None:
    """Correct a person with a measurement that surely belongs to them, in place."""
    moved, spread, root = np.empty((1, 1, 4)), np.empty((1, 1, 4, 4)), np.empty((4, 2))
    for mode in range(len(people.weight)):
        mean, covariance = people.mean, people.covariance
        correct(mean, covariance, mode, person, claims, row, dof, moved, spread, 0, root)
        for i in range(4):
            mean[mode, person, i] = moved[0, 0, i]
            for j in range(4):
                covariance[mode, person, i, j] = spread[0, 0, i, j]


@step
def correct(
    mean: FloatArray,
    covariance: FloatArray,
    mode: int,
    person: int,
    claims: Claims,
    row: int,
    dof: float,
    new_mean: FloatArray,
    new: FloatArray,
    to: int,
    root: FloatArray,
) -> None:
    """The Kalman filter's measurement update, x + K y and P - K S K', of one track in one mode.

    With S = L L' the gain's part is a square, W W' where W = P H' inv(L)': what is taken off P is
    symmetric as it stands.

    Args:
        mean: Shape (K, N, 4).
        covariance: Shape (K, N, 4, 4).
        mode: Row of the mode.
        person: Row of the person.
        claims: M claims.
        row: The claim's.
        dof: Degrees of freedom of the range's Student-t noise; 0 is Gaussian.
        new_mean: Shape (1, T, 4): the posterior's is written to row `to`.
        new: Shape (1, T, 4, 4).
        to: Where to.
        root: Shape (4, 2): room to work in, for W.
    """
    kind = claims.kind[row]
    expected, h, own, doubt = seen_from(kind, mean, covariance, mode, person, claims, row)
    y, r = innovation_of(kind, expected, claims, row), noise_of(kind, claims, row)
    r00, r01, r11 = r[0] + doubt[0], r[1] + doubt[1], r[2] + doubt[2]
    if dof > 0.0 and kind != POSITION and kind != BEARING:
        r11 = outlier_variance(y, own, (r00, r01, r11), dof)
    l00 = np.sqrt(own[0] + max(r00, NOISE_SHARE_MIN * own[0]))
    l10 = (own[1] + r01) / l00
    l11 = np.sqrt(own[2] + max(r11, NOISE_SHARE_MIN * own[2]) - l10 * l10)
    y0 = y[0] / l00
    y1 = (y[1] - l10 * y0) / l11
    for i in range(4):
        by_x, by_y = covariance[mode, person, i, 0], covariance[mode, person, i, 1]
        root[i, 0] = (by_x * h[0] + by_y * h[1]) / l00
        root[i, 1] = (by_x * h[2] + by_y * h[3] - l10 * root[i, 0]) / l11
    for i in range(4):
        new_mean[0, to, i] = mean[mode, person, i] + root[i, 0] * y0 + root[i, 1] * y1
        for j in range(i + 1):
            both = covariance[mode, person, i, j] + covariance[mode, person, j, i]
            taken = root[i, 0] * root[j, 0] + root[i, 1] * root[j, 1]
            new[0, to, i, j] = new[0, to, j, i] = both * 0.5 - taken
