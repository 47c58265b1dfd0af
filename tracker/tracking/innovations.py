"""How far were measurements from what was predicted? What a watcher of the tracker is told.

    innovation y = z - h(x),    S = H P H' + R,    NIS = y' inv(S) y.

A tracker that is given a `Watch` calls it once for each round of association: raised hands first,
everything else after. Without one, nothing here runs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from scipy.special import gammaln

from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, IntArray, Measurements, SensorKind
from tracker.tracking.filter import compare
from tracker.tracking.gating import Pairs
from tracker.tracking.modes import Belief


@dataclass(frozen=True, slots=True, eq=False)
class Round:
    """One round of association, before its measurements count: N people, M measurements.

    Attributes:
        stamp_ns: Of the measurements.
        id: Shape (N,): identities of customers; 0 for bystanders.
        belief: Predicted.
        existence: Shape (N,).
        chance: Shape (N,): of being detected in this round.
        claims: As the filter sees them, with the noise that it supposes.
        pairs: Inside the gates.
        chosen: Rows of `pairs` that the most likely assignment takes.
        config: The tracker's parameters.
    """

    stamp_ns: int
    id: IntArray
    belief: Belief
    existence: FloatArray
    chance: FloatArray
    claims: Measurements
    pairs: Pairs
    chosen: IntArray
    config: Config


Watch: TypeAlias = Callable[[Round], None]


@dataclass(frozen=True, slots=True, eq=False)
class Innovations:
    """K measurements, each held against the person whom it was assigned to.

    Attributes:
        stamp_ns: Shape (K,).
        id: Shape (K,): identities of customers; 0 for bystanders.
        innovation: Shape (K, 2): bearing and range, or x and y; 0 in the place of a missing range.
        covariance: Shape (K, 2, 2): S, by the noise R that was stated. Ranges under `outlier_dof`
            are heavier-tailed than that.
        ranged: Shape (K,): two numbers were measured; otherwise a bearing alone.
        raised: Shape (K,): it was a raised hand.
        log_likelihood: Shape (K,): under the filter's own density, heavy tails and all.
        nis: Shape (K,): chi-square of two or one degrees of freedom where filter and world agree.
    """

    stamp_ns: IntArray
    id: IntArray
    innovation: FloatArray
    covariance: FloatArray
    ranged: BoolArray
    raised: BoolArray
    log_likelihood: FloatArray
    nis: FloatArray

    def __len__(self) -> int:
        return len(self.stamp_ns)

    def __getitem__(self, rows: BoolArray | IntArray | slice) -> Innovations:
        return Innovations(*(getattr(self, name)[rows] for name in self.__slots__))

    @staticmethod
    def concatenate(parts: Sequence[Innovations]) -> Innovations:
        """One batch of one or more, in order."""
        return Innovations(
            *(
                np.concatenate([getattr(part, name) for part in parts])
                for name in Innovations.__slots__
            )
        )


def innovations_of(round_: Round) -> Innovations:
    """Innovations of one round's assigned pairs; modes of motion count by their probability."""
    pairs = round_.pairs[round_.chosen]
    claims = round_.claims[pairs.claim]
    mean, covariance = round_.belief.merged()
    mean, covariance = mean[pairs.track], covariance[pairs.track]
    innovation, jacobian, noise = compare(mean, claims)
    spread = jacobian @ covariance[:, :2, :2] @ np.swapaxes(jacobian, -1, -2) + noise
    solved = np.linalg.solve(spread, innovation[..., None])[..., 0]
    return Innovations(
        stamp_ns=np.full(len(pairs), round_.stamp_ns, dtype=np.int64),
        id=round_.id[pairs.track],
        innovation=innovation,
        covariance=spread,
        ranged=~np.isnan(claims.values[:, 1]),
        raised=claims.raised,
        log_likelihood=log_densities(round_, pairs),
        nis=(innovation * solved).sum(axis=-1),
    )


def log_densities(round_: Round, pairs: Pairs) -> FloatArray:
    """Log-density of each pair's measurement, were it the track's, shape (P,).

    Modes of motion count by their probability. A Student-t's tail has its own normalization here,
    so that densities under different `outlier_dof` compare; the assignment does without.
    """
    weight = round_.belief.weight[:, pairs.track]
    density = np.logaddexp.reduce(pairs.log_likelihood + np.log(weight), axis=0)
    dof = round_.config.outlier_dof
    if dof > 0.0:
        claims = round_.claims[pairs.claim]
        tailed = claims.kind == SensorKind.BEARING_RANGE
        tail = gammaln((dof + 1.0) / 2.0) - gammaln(dof / 2.0) - 0.5 * np.log(dof / 2.0)
        density = density + np.where(tailed, tail, 0.0)
    return np.asarray(density)
