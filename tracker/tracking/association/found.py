"""Who was found in this frame, and by which measurement?"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.compiling.loops import loop, maker
from tracker.containers import BoolArray, FloatArray, IntArray
from tracker.tracking.association.gating import Pairs
from tracker.tracking.sensing.claims import Claims

NOBODY, NOT_IN = -1, -2


class Found(NamedTuple):
    """Of N people and M claims.

    Attributes:
        is_called: Shape (N,): a raised hand was theirs.
        certainty: Shape (N,): how probably a measurement was theirs, at best; 0 for none.
        hand: Shape (N,): row of this frame's `Hands` that is theirs, or -1.
        owner: Shape (M,): row of the person whose each claim is; NOBODY, or NOT_IN for those that
            did not come in.
    """

    is_called: BoolArray
    certainty: FloatArray
    hand: IntArray
    owner: IntArray


@maker
def nothing_found(people: int, claims: int, rows: IntArray) -> Found:
    """The state before the first round; `rows` are the measurements that are used."""
    found = Found(
        np.empty(people, np.bool_), np.empty(people),
        np.empty(people, np.int64), np.empty(claims, np.int64),
    )  # fmt: skip
    for person in range(people):
        found.is_called[person], found.certainty[person], found.hand[person] = False, 0.0, -1
    for row in range(claims):
        found.owner[row] = NOT_IN
    for row in rows:
        found.owner[row] = NOBODY
    return found


@loop
def take(
    found: Found, chosen: IntArray, probability: FloatArray, pairs: Pairs, claims: Claims
) -> None:
    """Note to whom the measurements of a round belong.

    Args:
        found: Changed in place.
        chosen: Shape (N,): row of each track's pair, or -1.
        probability: Shape (P,): how probably each pair is one.
        pairs: P pairs.
        claims: M claims.
    """
    for person in range(len(chosen)):
        if chosen[person] < 0:
            continue
        row = pairs.claim[chosen[person]]
        found.owner[row] = person
        if not found.is_called[person]:
            found.hand[person] = claims.hand[row]
        found.certainty[person] = max(found.certainty[person], probability[chosen[person]])
        if claims.raised[row]:
            found.is_called[person] = True
