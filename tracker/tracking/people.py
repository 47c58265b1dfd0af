"""What does the tracker remember of each customer between two frames?"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray, Tracks
from tracker.tracking.streaks import Streaks


@dataclass(frozen=True, slots=True, eq=False)
class People:
    """Stacked state of all tracks; row i of each array is the same person.

    Attributes:
        id: Shape (N,), int64.
        mean: Shape (N, 4): x_m, y_m, vx_mps, vy_mps in the fixed frame.
        covariance: Shape (N, 4, 4).
        existence: Shape (N,): probability that somebody is there.
        confirmed: Shape (N,), bool.
        recent: Shape (N, W), bool: raised-hand detections of the last W frames, newest first.
        streaks: The raised-hand counters.
        raised_since_ns: Shape (N,): when the hand last began to count as raised; -1 never.
        born_ns: Shape (N,): stamp of the first measurement.
        seen_ns: Shape (N,): stamp of the last measurement of any kind.
        called_ns: Shape (N,): stamp of the last raised-hand measurement.
        hand: Shape (N,): row of this frame's `Hands`, or -1.
    """

    id: IntArray
    mean: FloatArray
    covariance: FloatArray
    existence: FloatArray
    confirmed: BoolArray
    recent: BoolArray
    streaks: Streaks
    raised_since_ns: IntArray
    born_ns: IntArray
    seen_ns: IntArray
    called_ns: IntArray
    hand: IntArray

    def __len__(self) -> int:
        return len(self.id)

    def __getitem__(self, rows: Any) -> People:
        return People(*(getattr(self, item.name)[rows] for item in fields(People)))

    @staticmethod
    def begin(
        ids: IntArray,
        mean: FloatArray,
        covariance: FloatArray,
        stamp_ns: int,
        window: int,
        existence: float,
    ) -> People:
        """People who have just been seen for the first time; nothing is counted yet."""
        count = len(ids)
        now = np.full(count, stamp_ns, dtype=np.int64)
        return People(
            id=ids,
            mean=mean,
            covariance=covariance,
            existence=np.full(count, existence),
            confirmed=np.zeros(count, dtype=bool),
            recent=np.zeros((count, window), dtype=bool),
            streaks=Streaks.begin(count),
            raised_since_ns=np.full(count, -1, dtype=np.int64),
            born_ns=now,
            seen_ns=now,
            called_ns=now,
            hand=np.full(count, -1, dtype=np.int64),
        )

    @staticmethod
    def nobody(window: int) -> People:
        """No track at all."""
        ids = np.zeros(0, dtype=np.int64)
        return People.begin(ids, np.zeros((0, 4)), np.zeros((0, 4, 4)), 0, window, 0.0)

    def append(self, other: People) -> People:
        """Rows of both, in order."""
        joined = {
            item.name: np.concatenate([getattr(self, item.name), getattr(other, item.name)])
            for item in fields(People)
            if item.name != "streaks"
        }
        return People(streaks=self.streaks.append(other.streaks), **joined)

    def replace(self, **changes: Any) -> People:
        """The same people with some arrays changed."""
        return replace(self, **changes)

    def as_tracks(self, stamp_ns: int, selected_id: int | None = None) -> Tracks:
        """What the outside sees of them."""
        return Tracks(
            stamp_ns=stamp_ns,
            id=self.id,
            mean=self.mean,
            covariance=self.covariance,
            existence=self.existence,
            confirmed=self.confirmed,
            raised=self.streaks.raised,
            raised_since_ns=self.raised_since_ns,
            age_s=(stamp_ns - self.born_ns) / 1e9,
            unseen_s=(stamp_ns - self.seen_ns) / 1e9,
            hand=self.hand,
            selected_id=selected_id,
        )
