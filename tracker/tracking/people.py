"""What does the tracker remember of each customer between two frames?"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracker.containers import BoolArray, FloatArray, IntArray, Tracks
from tracker.containers.arrays import frozen, sealed, trusted
from tracker.tracking.modes import Belief
from tracker.tracking.streaks import Streaks

#: Rows of `People.spans`, `counts` and `flags`; ages are taken from birth and sight, side by side.
EXISTENCE, MISSING_S = range(2)
ID, BORN_NS, SEEN_NS, CALLED_NS, RAISED_SINCE_NS, DETECTED, MISSED, DETECTIONS, HAND = range(9)
RAISED, CONFIRMED = range(2)


class _Row:
    """One row of one of the tables, by its own name."""

    def __init__(self, table: str, row: int) -> None:
        self.table, self.row = table, row

    def __get__(self, people: People, kind: type[People]) -> NDArray[Any]:
        row: NDArray[Any] = getattr(people, self.table)[self.row]
        return row


@dataclass(frozen=True, eq=False)
class People:
    """Stacked state of all tracks; row i of each array named below is the same person.

    Few arrays hold it, one for each type of number, so that compiled loops take it as it is. All
    are read-only.

    Attributes:
        belief: Where they are, in each mode of motion.
        spans: Shape (2, N): probabilities and durations.
        counts: Shape (9, N), int64: identities, numbers and stamps.
        flags: Shape (2, N), bool.
        recent: Shape (N, W), bool: raised-hand detections of the last W frames, newest first.
        id: Shape (N,), int64; 0 for bystanders, whose hand has never been up.
        existence: Shape (N,): probability that somebody is there.
        confirmed: Shape (N,), bool.
        detected: Shape (N,): the streaks' counters and their word, as `Streaks` has them.
        missed: Shape (N,).
        raised: Shape (N,), bool.
        detections: Shape (N,): raised-hand detections in all.
        raised_since_ns: Shape (N,): when the hand last began to count as raised; -1 never.
        born_ns: Shape (N,): stamp of the first measurement.
        seen_ns: Shape (N,): stamp of the last measurement of any kind.
        called_ns: Shape (N,): stamp of the last raised-hand measurement.
        missing_s: Shape (N,): time in which nothing showed them although they were in view.
        hand: Shape (N,): row of this frame's `Hands`, or -1.
    """

    belief: Belief
    spans: FloatArray
    counts: IntArray
    flags: BoolArray
    recent: BoolArray

    id = _Row("counts", ID)
    existence = _Row("spans", EXISTENCE)
    confirmed = _Row("flags", CONFIRMED)
    raised = _Row("flags", RAISED)
    detected = _Row("counts", DETECTED)
    missed = _Row("counts", MISSED)
    detections = _Row("counts", DETECTIONS)
    raised_since_ns = _Row("counts", RAISED_SINCE_NS)
    born_ns = _Row("counts", BORN_NS)
    seen_ns = _Row("counts", SEEN_NS)
    called_ns = _Row("counts", CALLED_NS)
    missing_s = _Row("spans", MISSING_S)
    hand = _Row("counts", HAND)

    def __post_init__(self) -> None:
        modes = self.belief.weight, self.belief.mean, self.belief.covariance
        for array in (*modes, self.spans, self.counts, self.flags, self.recent):
            sealed(array)

    def __len__(self) -> int:
        people: int = self.counts.shape[1]
        return people

    def __getitem__(self, rows: Any) -> People:
        return People(
            self.belief[rows],
            self.spans[:, rows],
            self.counts[:, rows],
            self.flags[:, rows],
            self.recent[rows],
        )

    @property
    def streaks(self) -> Streaks:
        """The raised-hand counters."""
        return Streaks(self.detected, self.missed, self.raised)

    @property
    def is_customer(self) -> BoolArray:
        """Shape (N,): a hand has been up."""
        return self.id > 0

    def customers(self) -> People:
        """Those with an identity, in its order."""
        ids = self.id.tolist()  # few numbers are compared faster one by one
        if ids == sorted(ids) and 0 not in ids[:1]:
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
    ) -> People:
        """People who have just been seen for the first time; nothing is counted yet."""
        count = len(ids)
        spans, counts = np.zeros((2, count)), np.zeros((9, count), dtype=np.int64)
        spans[EXISTENCE] = existence
        counts[ID] = ids
        counts[[BORN_NS, SEEN_NS, CALLED_NS]] = stamp_ns
        counts[[RAISED_SINCE_NS, HAND]] = -1
        flags = np.zeros((2, count), dtype=bool)
        recent = np.zeros((count, window), dtype=bool)
        return People(belief, spans, counts, flags, recent)

    @staticmethod
    def nobody(window: int, modes: int) -> People:
        """No track at all."""
        belief = Belief.begin(np.zeros((0, 4)), np.zeros((0, 4, 4)), modes, 0.0)
        return People.begin(np.zeros(0, dtype=np.int64), belief, 0, window, np.zeros(0))

    def append(self, other: People) -> People:
        """Rows of both, in order."""
        return People(
            self.belief.append(other.belief),
            np.concatenate([self.spans, other.spans], axis=1),
            np.concatenate([self.counts, other.counts], axis=1),
            np.concatenate([self.flags, other.flags], axis=1),
            np.concatenate([self.recent, other.recent]),
        )

    def replace(self, **changes: Any) -> People:
        """The same people with some arrays changed, the streaks' among them."""
        changed: dict[str, Any] = {}
        if "streaks" in changes:
            streaks = changes.pop("streaks")
            changes |= {item.name: getattr(streaks, item.name) for item in fields(streaks)}
        for name, value in changes.items():
            place = vars(People).get(name)
            if not isinstance(place, _Row):
                changed[name] = value
                continue
            if place.table not in changed:
                changed[place.table] = getattr(self, place.table).copy()
            changed[place.table][place.row] = value
        return replace(self, **changed)

    def as_tracks(self, stamp_ns: int, selected_id: int | None) -> Tracks:
        """What the outside sees of them."""
        mean, covariance = self.belief.merged()
        counts, flags = self.counts, self.flags
        lapse_s = (stamp_ns - counts[BORN_NS : SEEN_NS + 1]).astype(np.float64)
        lapse_s /= 1e9
        sealed(lapse_s)
        return trusted(
            Tracks,
            stamp_ns=stamp_ns,
            id=counts[ID],
            mean=frozen(mean),
            covariance=frozen(covariance),
            existence=self.spans[EXISTENCE],
            confirmed=flags[CONFIRMED],
            raised=flags[RAISED],
            raised_since_ns=counts[RAISED_SINCE_NS],
            age_s=lapse_s[0],
            unseen_s=lapse_s[1],
            hand=counts[HAND],
            selected_id=selected_id,
        )
