"""Which hands are in one image?"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from enum import IntEnum
from typing import Annotated

import numpy as np

from tracker.containers.arrays import BoolArray, FloatArray, IntArray
from tracker.containers.rows import Column, Rows


class Refusal(IntEnum):
    """Why a hand that was found is not raised."""

    NO_REASON = 0
    NOT_UP = 1
    LEANS = 2
    CLOSED = 3
    UNSURE = 4
    TOO_BRIEF = 5
    OWNER_UNKNOWN = 6
    AT_HEAD = 7
    BELOW_SHOULDERS = 8
    ARM_DOWN = 9
    BEFORE_BODY = 10
    ALWAYS_THERE = 11
    OTHER_SIGN = 12

    @property
    def words(self) -> str:
        """For people, in a few words."""
        return _WORDS[self]


_WORDS = {
    Refusal.NO_REASON: "not up",
    Refusal.NOT_UP: "fingers not stretched up",
    Refusal.LEANS: "leans aside",
    Refusal.CLOSED: "fingers not spread",
    Refusal.UNSURE: "unsure hand",
    Refusal.TOO_BRIEF: "just up",
    Refusal.OWNER_UNKNOWN: "owner unknown",
    Refusal.AT_HEAD: "at the head",
    Refusal.BELOW_SHOULDERS: "below the shoulders",
    Refusal.ARM_DOWN: "arm not up",
    Refusal.BEFORE_BODY: "in front of the body",
    Refusal.ALWAYS_THERE: "always there, like a poster",
    Refusal.OTHER_SIGN: "a sign that is no call",
}


@dataclass(frozen=True, eq=False)
class Hands(Rows):
    """Every hand found in one image; row i of each array is the same hand.

    Attributes:
        landmarks_px: Shape (H, 21, 2): x to the right, y down, in pixels of the full image, in
            MediaPipe's order (0 wrist, 4 thumb tip, 9 middle finger's root, 12 its tip, 20 pinky
            tip).
        score: Shape (H,): the landmark model's probability that this is a hand, in [0, 1].
        right: Shape (H,): probability of a right hand, in [0, 1].
        raised: Shape (H,), bool: whether the raise rule calls it raised in this image.
        raise_measure: Shape (H,): what the rule compared with its threshold (a probability for the
            `evidence` rule, image heights for `image`, palm lengths for `palm`).
        torso_px: Shape (H, 2): the middle of the owner's shoulders and hips; NaN where unknown.
            None means unknown for all.
        refusal: Shape (H,), int64: the `Refusal`: why a hand is not raised; 0 for raised hands,
            and where there is no reason. None means 0 for all.
        seated: Shape (H,), in [0, 1]: whether the owner sits; NaN where unknown. None means
            unknown for all.
        gesture: Shape (H,), int64: the `tracker.gesture.Gesture`; 0 (NONE) where it is not sure.
            None means 0 for all.
        wrist_only: Shape (H,), bool: only a forearm was seen, and all landmarks except the wrist
            are assumed. None means False for all.
    """

    landmarks_px: Annotated[FloatArray, Column((21, 2))]
    score: FloatArray
    right: FloatArray
    raised: BoolArray
    raise_measure: FloatArray
    torso_px: Annotated[FloatArray, Column((2,), missing=np.nan)] = None  # type: ignore[assignment]
    refusal: Annotated[IntArray, Column(missing=0)] = None  # type: ignore[assignment]
    seated: Annotated[FloatArray, Column(missing=np.nan)] = None  # type: ignore[assignment]
    gesture: Annotated[IntArray, Column(missing=0)] = None  # type: ignore[assignment]
    wrist_only: Annotated[BoolArray, Column(missing=False)] = None  # type: ignore[assignment]

    @property
    def wrist_px(self) -> FloatArray:
        """Shape (H, 2)."""
        return self.landmarks_px[:, 0]

    @property
    def is_owned(self) -> BoolArray:
        """Shape (H,): the owner's torso is known."""
        return np.asarray(np.isfinite(self.torso_px).all(axis=-1))

    @property
    def refusals(self) -> Counter[Refusal]:
        """How many hands are not raised for which reason."""
        return Counter(Refusal(code) for code in self.refusal[~self.raised].tolist())

    @property
    def length_px(self) -> FloatArray:
        """Shape (H,): from the wrist to the middle finger's tip."""
        along = self.landmarks_px[:, 12] - self.landmarks_px[:, 0]
        return np.hypot(along[:, 0], along[:, 1])
