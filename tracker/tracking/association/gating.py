"""Which measurements could belong to which tracks?

Inside the gate is whatever has a squared distance y' inv(S) y below the chi-square quantile of
`gate_probability`, of one number for a bearing or a range alone and of two otherwise; ranges have
a Student-t's distance under `outlier_dof`. With two modes of motion, the one Gaussian with their
moments decides. The log-odds of a pair say how much likelier it is than its track missed and its
measurement somebody else's:

    log( Pd N(y; 0, S) ) - log( (1 - Pd) lambda )
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.compiling.loops import loop, maker, step
from tracker.containers import FloatArray, IntArray
from tracker.tracking.people import TAG, People
from tracker.tracking.sensing.claims import Claims
from tracker.tracking.sensing.innovation import (
    innovation_of,
    noise_of,
    seen_from,
    squared_distance,
)
from tracker.tracking.sensing.sensor_kinds import BEARING, POSITION, RANGE, area
from tracker.tracking.settings import Settings

_LOG_TURN = float(np.log(2.0 * np.pi))
#: How much a hint of identity tells, for the person whom it names and against others, as log-odds.
LOG_IDENTITY = 5.0


class Pairs(NamedTuple):
    """P pairs of a track and a measurement inside its gate, by track.

    Attributes:
        track: Shape (P,): row of the track.
        claim: Shape (P,): row of the measurement.
        log_likelihood: Shape (P, K), of the measurement, were it the track's.
        log_newcomer: Shape (P,): log-density of such measurements from nobody known.
        log_odds: Shape (P,): against "missed, and somebody else's".
    """

    track: IntArray
    claim: IntArray
    log_likelihood: FloatArray
    log_newcomer: FloatArray
    log_odds: FloatArray


@maker
def find_pairs(
    people: People,
    mean: FloatArray,
    covariance: FloatArray,
    claims: Claims,
    rows: IntArray,
    chance: FloatArray,
    likeness: FloatArray,
    density: float,
    settings: Settings,
) -> Pairs:
    """Pairs inside the gate.

    Args:
        people: N tracks, predicted.
        mean: Shape (1, N, 4), over the modes.
        covariance: Shape (1, N, 4, 4).
        claims: M claims.
        rows: Shape (C,): those of one sensor that count, those of one kind side by side.
        chance: Shape (N,): of being detected.
        likeness: Shape (N, M): added to the log-odds; empty for nothing.
        density: Of such measurements of nobody known, per square meter.
        settings: Of the tracker.
    """
    modes, tracks, pairs = len(people.weight), people.weight.shape[1], 0
    track = np.empty(tracks * len(rows), np.int64)
    claim = np.empty(tracks * len(rows), np.int64)
    for person in range(tracks):
        begin = pairs
        pairs = _inside_gate(person, mean, covariance, claims, rows, claim, begin, settings)
        for pair in range(begin, pairs):
            track[pair] = person
    log_likelihood, log_newcomer = np.empty((pairs, modes)), np.empty(pairs)
    log_odds = np.empty(pairs)
    for pair in range(pairs):
        person, row, likelihood = track[pair], claim[pair], 0.0
        for mode in range(modes):
            likely = _log_likelihood(people, mode, person, claims, row, settings)
            log_likelihood[pair, mode] = likely
            if modes == 2:
                likely += np.log(people.weight[mode, person])
            likelihood = likely if mode == 0 else log_of_sum(likelihood, likely)
        log_newcomer[pair] = np.log(density * area(claims.kind[row], claims, row, settings))
        log_missed = np.log(chance[person] / (1.0 - chance[person]))
        log_odds[pair] = likelihood - log_newcomer[pair] + log_missed
        log_odds[pair] += _log_likeness(people, person, claims, row, likeness)
    return Pairs(track[:pairs], claim[:pairs], log_likelihood, log_newcomer, log_odds)


@loop
def _inside_gate(
    person: int,
    mean: FloatArray,
    covariance: FloatArray,
    claims: Claims,
    rows: IntArray,
    near: IntArray,
    count: int,
    settings: Settings,
) -> int:
    """Append the rows inside a person's gate; returns the new end."""
    kind = -1
    expected, own = (0.0, 0.0), (0.0, 0.0, 0.0)
    limit, far, dof = 0.0, 0.0, 0.0
    for place in range(len(rows)):
        row = rows[place]
        if claims.kind[row] != kind:
            kind = claims.kind[row]
            expected, h, own, doubt = seen_from(kind, mean, covariance, 0, person, claims, row)
            own = floored(own, h, doubt, settings)
            dof = 0.0 if kind == POSITION else settings.outlier_dof
            limit = settings.ranged_limit
            if kind == BEARING or kind == RANGE:
                limit = settings.bearing_limit
            far = limit
            if dof > 0.0:  # ranges may be farther off, under the Student-t
                far = max(far, dof * np.expm1(limit / (dof + 1.0)))
        r = noise_of(kind, claims, row)
        # Each number alone rules most pairs out; the second first, since it does not wrap.
        apart = 0.0 if kind == BEARING else claims.values[row, 1] - expected[1]
        if apart * apart > far * (own[2] + r[2]):
            continue
        y = innovation_of(kind, expected, claims, row)
        if y[0] * y[0] > limit * (own[0] + r[0]):
            continue
        s = own[0] + r[0], own[1] + r[1], own[2] + r[2]
        if squared_distance(y, s, dof)[0] <= limit:
            near[count] = row
            count += 1
    return count


@loop
def distance_of(
    mean: FloatArray,
    covariance: FloatArray,
    mode: int,
    person: int,
    claims: Claims,
    row: int,
    settings: Settings,
) -> tuple[float, float]:
    """Squared distance of a claim from somebody in one mode of motion, and det S."""
    kind = claims.kind[row]
    expected, h, own, doubt = seen_from(kind, mean, covariance, mode, person, claims, row)
    own = floored(own, h, doubt, settings)
    y, r = innovation_of(kind, expected, claims, row), noise_of(kind, claims, row)
    s = own[0] + r[0], own[1] + r[1], own[2] + r[2]
    return squared_distance(y, s, 0.0 if kind == POSITION else settings.outlier_dof)


@step
def floored(
    own: tuple[float, float, float],
    h: tuple[float, float, float, float],
    doubt: tuple[float, float, float],
    settings: Settings,
) -> tuple[float, float, float]:
    """H P H' for gates and likelihoods, no less than `innovation_floor_m`, and the pose's doubt.

    An over-confident track shall find its measurements; what it makes of them stays Bayes' rule.
    """
    floor = settings.innovation_floor_m**2
    return (
        max(own[0], floor * (h[0] * h[0] + h[1] * h[1])) + doubt[0],
        own[1] + doubt[1],
        max(own[2], floor * (h[2] * h[2] + h[3] * h[3])) + doubt[2],
    )


@loop
def _log_likelihood(
    people: People, mode: int, person: int, claims: Claims, row: int, settings: Settings
) -> float:
    """Log N(y; 0, S) of a claim, were it somebody's, in one mode of motion."""
    distance, spanned = distance_of(
        people.mean, people.covariance, mode, person, claims, row, settings
    )
    numbers = 1.0 if claims.kind[row] == BEARING or claims.kind[row] == RANGE else 2.0
    return -0.5 * (distance + np.log(spanned) + numbers * _LOG_TURN)


@step
def _log_likeness(
    people: People, person: int, claims: Claims, row: int, likeness: FloatArray
) -> float:
    """Further evidence for a pair: the caller's likeness, and a hint of identity."""
    known, hint = people.counts[TAG, person], claims.tag[row]
    told = 0.0
    if known >= 0 and hint >= 0:
        told = LOG_IDENTITY if known == hint else -LOG_IDENTITY
    if len(likeness) > 0:
        told += likeness[person, row]
    return told


@step
def log_of_sum(first: float, second: float) -> float:
    """log(exp(a) + exp(b)) without overflow."""
    most = max(first, second)
    if most == -np.inf:
        return most
    return most + np.log1p(np.exp(-abs(first - second)))
