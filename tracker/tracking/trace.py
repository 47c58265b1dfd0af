"""What happened inside a frame? Arrays in which the loops record it for a watcher."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np

from tracker.compiling.loops import loop
from tracker.config import Config
from tracker.containers import FloatArray, IntArray
from tracker.tracking.association.gating import Pairs
from tracker.tracking.people import EXISTENCE, People
from tracker.tracking.sensing.claims import Claims


class Trace(NamedTuple):
    """R rounds of up to P pairs, N people in K modes; all empty where nobody watches.

    Attributes:
        pairs: Shape (R, P, 3), int64: track, claim, and whether the assignment takes it.
        counts: Shape (R,): how many pairs there are.
        rounds: Shape (1,): how many rounds there are.
        round_of: Shape (M,): of each measurement; -1 for those that did not come in.
        log_likelihood: Shape (R, P, K + 1), of each mode, and last a newcomer's log-density.
        belief: Shape (R, K, N, 21): weight, mean and covariance, before the round counts.
        people: Shape (R, N, 2): existence, and the chance of being detected.
    """

    pairs: IntArray
    counts: IntArray
    rounds: IntArray
    round_of: IntArray
    log_likelihood: FloatArray
    belief: FloatArray
    people: FloatArray

    @staticmethod
    def room(measured: int, modes: int, people: int) -> Trace:
        """Empty arrays, large enough for this many measurements and people."""
        rounds, pairs = measured, measured * people
        return Trace(
            np.zeros((rounds, pairs, 3), dtype=np.int64),
            np.zeros(rounds, dtype=np.int64),
            np.zeros(min(rounds, 1), dtype=np.int64),
            np.full(measured, -1),
            np.zeros((rounds, pairs, modes + 1)),
            np.zeros((rounds, modes, people, 21)),
            np.zeros((rounds, people, 2)),
        )


#: Nobody watches.
NO_TRACE = Trace.room(0, 0, 0)


@dataclass(frozen=True, slots=True, eq=False)
class Watched:
    """One frame, for a watcher; `evaluation.metrics.rounds` reads it.

    Attributes:
        stamp_ns: This frame's.
        people: As they were before.
        claims: M claims.
        trace: What happened.
        config: The tracker's parameters.
    """

    stamp_ns: int
    people: People
    claims: Claims
    trace: Trace
    config: Config


Watch: TypeAlias = Callable[[Watched], None]


@loop
def note_round(
    trace: Trace,
    number: int,
    rows: IntArray,
    people: People,
    chance: FloatArray,
    pairs: Pairs,
    chosen: IntArray,
) -> None:
    """Write down one round, before its measurements count.

    Args:
        trace: Where to.
        number: Of the round.
        rows: Shape (C,): its measurements.
        people: N tracks, predicted.
        chance: Shape (N,): of being detected.
        pairs: P pairs.
        chosen: Shape (N,): row of each track's pair, or -1.
    """
    if len(trace.counts) == 0:
        return
    trace.rounds[0], trace.counts[number] = number + 1, len(pairs.track)
    for row in rows:
        trace.round_of[row] = number
    for pair in range(len(pairs.track)):
        person = pairs.track[pair]
        trace.pairs[number, pair, 0] = person
        trace.pairs[number, pair, 1] = pairs.claim[pair]
        trace.pairs[number, pair, 2] = chosen[person] == pair
        modes = pairs.log_likelihood.shape[1]
        for mode in range(modes):
            trace.log_likelihood[number, pair, mode] = pairs.log_likelihood[pair, mode]
        trace.log_likelihood[number, pair, modes] = pairs.log_newcomer[pair]
    for person in range(len(chance)):
        trace.people[number, person, 0] = people.spans[EXISTENCE, person]
        trace.people[number, person, 1] = chance[person]
        for mode in range(len(people.weight)):
            page = trace.belief[number, mode, person]
            page[0] = people.weight[mode, person]
            for i in range(4):
                page[1 + i] = people.mean[mode, person, i]
                for j in range(4):
                    page[5 + 4 * i + j] = people.covariance[mode, person, i, j]
