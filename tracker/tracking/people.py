"""What does the tracker remember of each customer between two frames?"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray, Tracks
from tracker.tracking.appearance import Appearance
from tracker.tracking.modes import Belief
from tracker.tracking.streaks import Streaks


@dataclass(frozen=True, slots=True, eq=False)
class People:
    """Stacked state of all tracks; row i of each array is the same person.

    Attributes:
        id: Shape (N,), int64; 0 for bystanders, whose hand has never been up.
        belief: Where they are, in each mode of motion.
        existence: Shape (N,): probability that somebody is there.
        confirmed: Shape (N,), bool.
        recent: Shape (N, W), bool: raised-hand detections of the last W frames, newest first.
        detections: Shape (N,): raised-hand detections in all.
        streaks: The raised-hand counters.
        raised_since_ns: Shape (N,): when the hand last began to count as raised; -1 never.
        born_ns: Shape (N,): stamp of the first measurement.
        seen_ns: Shape (N,): stamp of the last measurement of any kind.
        called_ns: Shape (N,): stamp of the last raised-hand measurement.
        missing_s: Shape (N,): time in which nothing showed them although they were in view.
        hand: Shape (N,): row of this frame's `Hands`, or -1.
        appearance: What they wear.
    """

    id: IntArray
    belief: Belief
    existence: FloatArray
    confirmed: BoolArray
    recent: BoolArray
    detections: IntArray
    streaks: Streaks
    raised_since_ns: IntArray
    born_ns: IntArray
    seen_ns: IntArray
    called_ns: IntArray
    missing_s: FloatArray
    hand: IntArray
    appearance: Appearance

    def __len__(self) -> int:
        return len(self.id)

    def __getitem__(self, rows: Any) -> People:
        return People(*(getattr(self, name)[rows] for name in _NAMES))

    @property
    def is_customer(self) -> BoolArray:
        """Shape (N,): a hand has been up."""
        return self.id > 0

    def customers(self) -> People:
        """Those with an identity, in its order."""
        ids = self.id.tolist()  # few numbers are compared faster one by one
        if 0 not in ids and ids == sorted(ids):
            return self  # nearly always, without a scan
        order = np.argsort(self.id, kind="stable")
        return self[order[np.count_nonzero(self.id == 0) :]]

    @staticmethod
    def begin(
        ids: IntArray,
        belief: Belief,
        stamp_ns: int,
        window: int,
        existence: FloatArray,
        appearance: Appearance,
    ) -> People:
        """People who have just been seen for the first time; nothing is counted yet."""
        count = len(ids)
        now = np.full(count, stamp_ns, dtype=np.int64)
        return People(
            id=ids,
            belief=belief,
            existence=existence,
            confirmed=np.zeros(count, dtype=bool),
            recent=np.zeros((count, window), dtype=bool),
            detections=np.zeros(count, dtype=np.int64),
            streaks=Streaks.begin(count),
            raised_since_ns=np.full(count, -1, dtype=np.int64),
            born_ns=now,
            seen_ns=now,
            called_ns=now,
            missing_s=np.zeros(count),
            hand=np.full(count, -1, dtype=np.int64),
            appearance=appearance,
        )

    @staticmethod
    def nobody(window: int, modes: int) -> People:
        """No track at all."""
        belief = Belief.begin(np.zeros((0, 4)), np.zeros((0, 4, 4)), modes, 0.0)
        ids, nothing = np.zeros(0, dtype=np.int64), Appearance.unknown(0)
        return People.begin(ids, belief, 0, window, np.zeros(0), nothing)

    def append(self, other: People) -> People:
        """Rows of both, in order."""
        joined: dict[str, Any] = {}
        for name in _NAMES:
            mine, theirs = getattr(self, name), getattr(other, name)
            is_array = isinstance(mine, np.ndarray)
            joined[name] = np.concatenate([mine, theirs]) if is_array else mine.append(theirs)
        return People(**joined)

    def replace(self, **changes: Any) -> People:
        """The same people with some arrays changed."""
        return replace(self, **changes)

    def as_tracks(self, stamp_ns: int, selected_id: int | None) -> Tracks:
        """What the outside sees of them."""
        mean, covariance = self.belief.merged()
        return Tracks(
            stamp_ns=stamp_ns,
            id=self.id,
            mean=mean,
            covariance=covariance,
            existence=self.existence,
            confirmed=self.confirmed,
            raised=self.streaks.raised,
            raised_since_ns=self.raised_since_ns,
            age_s=(stamp_ns - self.born_ns) / 1e9,
            unseen_s=(stamp_ns - self.seen_ns) / 1e9,
            hand=self.hand,
            selected_id=selected_id,
        )


_NAMES = tuple(item.name for item in fields(People))
