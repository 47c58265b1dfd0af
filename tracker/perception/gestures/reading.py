"""The gesture of each hand from image to image, and which of them may call."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray, Hands, IntArray, Refusal
from tracker.gesture import Gesture
from tracker.perception.bodies.owners import hand_size_px
from tracker.perception.gestures.model import sign_probabilities
from tracker.perception.gestures.over_time import Look, SigningHand
from tracker.perception.gestures.shape import finger_stretch, palm_faces
from tracker.perception.verdict.memory import HandMemory, RememberedHand
from tracker.perception.verdict.raise_rules import MIDDLE_ROOT, MIDDLE_TIP, WRIST

#: As long as the memory of hands itself.
_FORGET_NS = 1_000_000_000
#: A palm, half as long as the open hand, that points up within 60 degrees.
_UPRIGHT = 0.25


class GestureReader:
    """Follows the hands that any detector has found, and reads their signs."""

    def __init__(self) -> None:
        self._memory = HandMemory()
        self._known: list[tuple[RememberedHand, SigningHand]] = []

    def read(self, stamp_ns: int, hands: Hands, config: Config) -> Hands:
        """The same hands with `gesture`; those whose sign is no call are not raised.

        Args:
            stamp_ns: Of the image; one that steps back begins anew.
            hands: In a picture in which up is up.
            config: `gesture_call`.
        """
        gesture = self._signs(stamp_ns, hands)
        is_other = hands.raised & is_other_sign(gesture, config)
        return replace(
            hands,
            gesture=gesture,
            raised=hands.raised & ~is_other,
            refusal=np.where(is_other, Refusal.OTHER_SIGN, hands.refusal),
        )

    def reset(self) -> None:
        """Forget all hands."""
        self._memory.reset()
        self._known = []

    def _signs(self, stamp_ns: int, hands: Hands) -> IntArray:
        items = self._memory.recognize(stamp_ns, hands)
        known = {id(item): signing for item, signing in self._known}
        pairs = [(item, known.get(id(item)) or SigningHand()) for item in items]
        now = set(map(id, items))
        self._known = pairs + [
            pair
            for pair in self._known
            if id(pair[0]) not in now and 0 <= stamp_ns - pair[0].seen_ns <= _FORGET_NS
        ]
        if not pairs:
            return np.zeros(0, dtype=np.int64)
        chances = sign_probabilities(hands.landmarks_px)
        chances[hands.wrist_only] = np.nan
        looks = _looks(stamp_ns, hands)
        told = [
            signing.see(*seen) for (_, signing), *seen in zip(pairs, looks, chances, strict=True)
        ]
        return np.array(told, dtype=np.int64)


def is_other_sign(gesture: IntArray, config: Config) -> BoolArray:
    """Shape (H,): hands that say something, and nothing that calls by `gesture_call`."""
    return ~np.isin(gesture, [Gesture.NONE, *config.calling_gestures])


def _looks(stamp_ns: int, hands: Hands) -> list[Look]:
    points = hands.landmarks_px
    size_px = np.maximum(hand_size_px(hands), 1.0)
    stretch = np.where(hands.wrist_only, np.nan, finger_stretch(points).mean(axis=-1))
    faces = palm_faces(points, hands.right)
    upright = points[:, WRIST, 1] - points[:, MIDDLE_ROOT, 1] > _UPRIGHT * size_px
    tip_px = np.where(hands.wrist_only[:, None], np.nan, points[:, MIDDLE_TIP])
    columns = (hands.wrist_px, tip_px, size_px, stretch, upright, faces, hands.raised)
    return [Look(stamp_ns, *row) for row in zip(*columns, strict=True)]
