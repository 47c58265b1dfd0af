"""Which hand of the last images is this, how did it move, and how probably does it call?"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import linear_sum_assignment

from tracker.containers import BoolArray, FloatArray, Hands, IntArray
from tracker.perception.bodies.owners import hand_size_px
from tracker.perception.verdict.belief import update_belief

#: A hand that waves goes so far from one image to the next, in its lengths ...
_REACH_HANDS = 1.5
#: ... and an unseen one is remembered for so long; one seen later is likelier by so many lengths
#: for each second.
_FORGET_AFTER_S, _OLDER_HANDS = 1.0, 6.0
#: Arms blur when they move: doubt about a body that was sure comes back in so long, s (guess).
_DOUBT_S = 2.0
#: A wave of the hand takes about half a second; so long a time shows two.
_SWING_S = 1.5
#: There and back once is no wave: a hand that was lost and found again does so.
_TURNS_MIN = 2
#: Steps shorter than this, in hand lengths, are noise; so long a way to and fro is a wave.
_STILL_HANDS, _WAVE_HANDS = 0.2, 2.5


@dataclass(slots=True)
class RememberedHand:
    """One hand, as it was in the last images.

    Attributes:
        wrist_px: Where it was last.
        size_px: Of it; see `hand_size_px`.
        seen_ns: When.
        log_odds: That it calls; NaN before the first verdict.
        calls: Whether it does.
        weighed_ns: When that was believed.
        faint: How much its owner's arms were doubted when they were seen best of late, 0 to 1.
        way: (stamp_ns, column of the wrist, whether the hand was found or a forearm ends there) in
            the images of the last `_SWING_S`.
    """

    wrist_px: FloatArray
    size_px: float
    seen_ns: int
    log_odds: float = float("nan")
    calls: bool = False
    weighed_ns: int = 0
    faint: float = 1.0
    way: list[tuple[int, float, bool]] = field(default_factory=list)

    def doubt(self, stamp_ns: int, faint: float) -> float:
        """The doubt about the owner's arms: who was a person a moment ago still is."""
        passed_s = (stamp_ns - self.weighed_ns) / 1e9 if self.weighed_ns else np.inf
        self.faint = min(faint, self.faint + passed_s / _DOUBT_S)
        return self.faint

    def weigh(
        self,
        stamp_ns: int,
        evidence: float,
        high_shoulders: float = float("nan"),
        is_old_look: bool = False,
    ) -> float:
        """The log-odds that the hand calls, after an image's evidence; see `update_belief`."""
        passed_s = (stamp_ns - self.weighed_ns) / 1e9
        self.log_odds = update_belief(
            self.log_odds, passed_s, evidence, high_shoulders, is_old_look
        )
        self.weighed_ns = stamp_ns
        return self.log_odds

    def swing(self) -> float:
        """How much the hand goes to and fro: 0 is still, or moves one way; 1 is a wave.

        Hand and forearm are not compared: where both models take turns, a hand seems to jump.
        """
        ways = ([column for _, column, found in self.way if found is one] for one in (True, False))
        return max(_swing(np.array(way) / max(self.size_px, 1.0)) for way in ways)


def _swing(way_hands: FloatArray) -> float:
    steps = np.diff(way_hands)
    steps = steps[np.abs(steps) > _STILL_HANDS]
    if np.count_nonzero(np.diff(np.sign(steps))) < _TURNS_MIN:
        return 0.0
    to_and_fro = np.abs(steps).sum() - abs(steps.sum())
    return float(min(to_and_fro / _WAVE_HANDS, 1.0))


class HandMemory:
    """Recognizes the hands of one image after the other by their places."""

    def __init__(self) -> None:
        self._hands: list[RememberedHand] = []

    def recognize(
        self, stamp_ns: int, hands: Hands, is_found: BoolArray | None = None
    ) -> list[RememberedHand]:
        """Get what is remembered of each hand of an image; of a new one, only where it is.

        Args:
            stamp_ns: The image's.
            hands: H hands.
            is_found: Shape (H,): the landmark model saw the hand; otherwise a forearm ends there.
                None means that it saw all.
        """
        if is_found is None:
            is_found = np.ones(len(hands), dtype=bool)
        kept = [
            item for item in self._hands if 0 <= stamp_ns - item.seen_ns <= _FORGET_AFTER_S * 1e9
        ]
        rows = _same_rows(kept, hands, stamp_ns)
        size_px = hand_size_px(hands)
        answer = []
        for row in range(len(hands)):
            if rows[row] < 0:
                item = RememberedHand(hands.wrist_px[row], 0.0, stamp_ns)
                kept.append(item)
            else:
                item = kept[rows[row]]
            item.wrist_px, item.seen_ns = hands.wrist_px[row], stamp_ns
            item.size_px = float(size_px[row])
            item.way = [step for step in item.way if stamp_ns - step[0] <= _SWING_S * 1e9]
            item.way.append((stamp_ns, float(hands.wrist_px[row, 0]), bool(is_found[row])))
            answer.append(item)
        self._hands = kept
        return answer

    def reset(self) -> None:
        """Forget all hands."""
        self._hands = []


def _same_rows(known: list[RememberedHand], hands: Hands, stamp_ns: int) -> IntArray:
    """Shape (H,): the remembered hand that each is; -1 for new ones."""
    rows = np.full(len(hands), -1, dtype=np.int64)
    if not known or len(hands) == 0:
        return rows
    places = np.array([item.wrist_px for item in known])
    length = np.fmax(hand_size_px(hands)[:, None], [item.size_px for item in known])
    apart = np.linalg.norm(hands.wrist_px[:, None] - places, axis=-1) / np.maximum(length, 8.0)
    age_s = np.array([stamp_ns - item.seen_ns for item in known]) / 1e9
    misfit = np.where(apart <= _REACH_HANDS, apart + _OLDER_HANDS * age_s, 100.0)
    pairs = linear_sum_assignment(misfit)
    for hand, item in zip(*pairs, strict=True):
        if apart[hand, item] <= _REACH_HANDS:
            rows[hand] = item
    return rows
