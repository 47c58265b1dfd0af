"""How far were measurements from what was predicted?

innovation y = z - h(x),    S = H P H' + R,    NIS = y' inv(S) y.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from scipy.special import gammaln

from tracker.containers import BoolArray, FloatArray, IntArray
from tracker.containers.rows import Column, Rows
from tracker.evaluation.metrics.rounds import Round
from tracker.tracking.prediction.modes import merge_modes
from tracker.tracking.sensing.innovation import innovation_of, noise_of, seen_from
from tracker.tracking.sensing.sensor_kinds import BEARING, POSITION, RANGE


@dataclass(frozen=True, eq=False)
class Innovations(Rows):
    """Innovations of K measurements, each with the person to whom it was assigned.

    Attributes:
        stamp_ns: Shape (K,).
        id: Shape (K,): identities; below 0 for bystanders.
        innovation: Shape (K, 2): bearing and range, or x and y; 0 in the place of a missing
            number.
        covariance: Shape (K, 2, 2): S, by the noise R that was stated. Ranges under `outlier_dof`
            are heavier-tailed than that.
        ranged: Shape (K,): two numbers were measured; otherwise a bearing or a range alone.
        raised: Shape (K,): it was a raised hand.
        log_likelihood: Shape (K,): under the filter's own density, heavy tails and all.
        nis: Shape (K,): chi-square of two or one degrees of freedom where filter and world agree.
    """

    stamp_ns: IntArray
    id: IntArray
    innovation: Annotated[FloatArray, Column((2,))]
    covariance: Annotated[FloatArray, Column((2, 2))]
    ranged: BoolArray
    raised: BoolArray
    log_likelihood: FloatArray
    nis: FloatArray


def innovations_of(round_: Round) -> Innovations:
    """Innovations of one round's assigned pairs; modes of motion count by their probability."""
    people, claims = len(round_.id), round_.claims
    mean, covariance = np.empty((1, people, 4)), np.empty((1, people, 4, 4))
    merge_modes(round_.weight, round_.mean, round_.covariance, mean[0], covariance[0])
    track, claim = round_.track[round_.is_chosen], round_.claim[round_.is_chosen]
    innovation, spread = np.empty((len(track), 2)), np.empty((len(track), 2, 2))
    for pair, (person, row) in enumerate(zip(track, claim, strict=True)):
        kind = claims.kind[row]
        expected, _, own, doubt = seen_from(kind, mean, covariance, 0, person, claims, row)
        innovation[pair] = innovation_of(kind, expected, claims, row)
        s00, s01, s11 = np.sum([own, doubt, noise_of(kind, claims, row)], axis=0)
        spread[pair] = [[s00, s01], [s01, s11]]
    solved = np.linalg.solve(spread, innovation[..., None])[..., 0]
    return Innovations(
        stamp_ns=np.full(len(track), round_.stamp_ns, dtype=np.int64),
        id=round_.id[track],
        innovation=innovation,
        covariance=spread,
        ranged=~np.isin(claims.kind[claim], (BEARING, RANGE)),
        raised=claims.raised[claim],
        log_likelihood=log_densities(round_)[round_.is_chosen],
        nis=(innovation * solved).sum(axis=-1),
    )


def log_densities(round_: Round) -> FloatArray:
    """Log-density of each pair's measurement, were it the track's, shape (P,).

    Modes of motion count by their probability. A Student-t's tail has its own normalization here,
    so that densities under different `outlier_dof` compare; the assignment does without.
    """
    weight = round_.weight[:, round_.track].T
    density = np.logaddexp.reduce(round_.log_likelihood + np.log(weight), axis=1)
    dof = round_.config.outlier_dof
    if dof > 0.0:
        tailed = ~np.isin(round_.claims.kind[round_.claim], (BEARING, POSITION))
        tail = gammaln((dof + 1.0) / 2.0) - gammaln(dof / 2.0) - 0.5 * np.log(dof / 2.0)
        density = density + np.where(tailed, tail, 0.0)
    return np.asarray(density)
