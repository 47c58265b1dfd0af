"""Who is where, and whose hand is up?"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from tracker.containers.arrays import BoolArray, FloatArray, IntArray
from tracker.containers.rows import Column, Rows


@dataclass(frozen=True, eq=False)
class Tracks(Rows):
    """Every customer at one instant; row i of each array is the same person.

    Attributes:
        stamp_ns: Sensor time the estimate is valid for.
        id: Shape (N,), int64, from 1; never reused by one tracker.
        mean: Shape (N, 4): x_m, y_m, vx_mps, vy_mps in the fixed frame.
        covariance: Shape (N, 4, 4), in the order and units of `mean`: of what is published. It is
            the filter's own, and on the position what lasts of the measurements' errors
            (`Measurements.bias_covariance`), which no filter averages out.
        existence: Shape (N,), probability that this person is really there.
        confirmed: Shape (N,), bool: seen often enough to be believed.
        raised: Shape (N,), bool: the streak says that this person's hand is up.
        raised_since_ns: Shape (N,): stamp at which `raised` last became true; -1 if it never did.
        age_s: Shape (N,): since the track began.
        unseen_s: Shape (N,): since a measurement last touched the position (freshness).
        hand: Shape (N,), int64: row of this image's `Hands` that belongs to the person, or -1.
        selected_id: The customer who is served, or None.
        refused: How many measurements told nothing: nobody's, and too little to show somebody new
            (a range alone).
        gesture: Shape (N,), int64: what the person's hand says, a `tracker.gesture.Gesture`; NONE,
            0, where nobody knows. None means 0 for all.
    """

    stamp_ns: int
    id: IntArray
    mean: Annotated[FloatArray, Column((4,))]
    covariance: Annotated[FloatArray, Column((4, 4))]
    existence: FloatArray
    confirmed: BoolArray
    raised: BoolArray
    raised_since_ns: IntArray
    age_s: FloatArray
    unseen_s: FloatArray
    hand: IntArray
    selected_id: int | None = None
    refused: int = 0
    gesture: Annotated[IntArray, Column(missing=0)] = None  # type: ignore[assignment]

    @property
    def customer(self) -> BoolArray:
        """Shape (N,), bool: a hand has been up; others are bystanders, with identities below 0."""
        return self.id > 0

    def row_of(self, track_id: int | None) -> int | None:
        """Row of a person, or None where the tracker does not know them (any more)."""
        if track_id is None:
            return None
        found = np.flatnonzero(self.id == track_id)
        return int(found[0]) if len(found) else None
