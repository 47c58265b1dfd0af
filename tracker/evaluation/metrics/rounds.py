"""What did the tracker do in each round of association? Its trace, as arrays with names."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, IntArray
from tracker.tracking.people import ID
from tracker.tracking.sensing.claims import Claims
from tracker.tracking.trace import Watched


@dataclass(frozen=True, slots=True, eq=False)
class Round:
    """One round of association, before its measurements count: N people, M measurements.

    Attributes:
        stamp_ns: Of the measurements.
        id: Shape (N,): identities; below 0 for bystanders.
        weight: Shape (K, N): of each mode of motion, predicted as the next two.
        mean: Shape (K, N, 4).
        covariance: Shape (K, N, 4, 4).
        existence: Shape (N,).
        chance: Shape (N,): of being detected in this round.
        claims: All of the frame, as the filter sees them, with the noise that it supposes.
        rows: Shape (C,): of the claims that are in this round.
        track: Shape (P,): pairs inside the gates.
        claim: Shape (P,): row of each pair's claim.
        log_likelihood: Shape (P, K).
        log_newcomer: Shape (P,): log-density of such measurements of nobody known.
        is_chosen: Shape (P,): the assignment takes this pair.
        config: The tracker's parameters.
    """

    stamp_ns: int
    id: IntArray
    weight: FloatArray
    mean: FloatArray
    covariance: FloatArray
    existence: FloatArray
    chance: FloatArray
    claims: Claims
    rows: IntArray
    track: IntArray
    claim: IntArray
    log_likelihood: FloatArray
    log_newcomer: FloatArray
    is_chosen: BoolArray
    config: Config


def rounds_of(watched: Watched) -> Iterator[Round]:
    """What a frame did, round by round: raised hands first, everything else after."""
    trace, people, claims = watched.trace, watched.people, watched.claims
    modes = len(people.weight)
    for number in range(trace.rounds[0] if len(trace.rounds) else 0):
        pairs = slice(0, trace.counts[number])
        belief, known = trace.belief[number], trace.people[number]
        likelihood = trace.log_likelihood[number, pairs]
        yield Round(
            stamp_ns=watched.stamp_ns,
            id=people.counts[ID],
            weight=belief[..., 0],
            mean=belief[..., 1:5],
            covariance=belief[..., 5:].reshape(modes, -1, 4, 4),
            existence=known[:, 0],
            chance=known[:, 1],
            claims=claims,
            rows=np.flatnonzero(trace.round_of == number),
            track=trace.pairs[number, pairs, 0],
            claim=trace.pairs[number, pairs, 1],
            log_likelihood=likelihood[:, :modes],
            log_newcomer=likelihood[:, modes],
            is_chosen=trace.pairs[number, pairs, 2] > 0,
            config=watched.config,
        )
