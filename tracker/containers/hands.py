"""Which hands are in one image?"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, fields
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracker.containers.arrays import (
    COUNTS,
    FLAGS,
    NUMBERS,
    BoolArray,
    FloatArray,
    IntArray,
    check_rows,
    select,
)

_LAYOUT = {
    "landmarks_px": (NUMBERS, (21, 2)),
    "score": (NUMBERS, ()),
    "right": (NUMBERS, ()),
    "raised": (FLAGS, ()),
    "raise_measure": (NUMBERS, ()),
    "torso_px": (NUMBERS, (2,)),
    "refusal": (COUNTS, ()),
    "seated": (NUMBERS, ()),
    "gesture": (COUNTS, ()),
    "wrist_only": (FLAGS, ()),
}


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
class Hands:
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

    landmarks_px: FloatArray
    score: FloatArray
    right: FloatArray
    raised: BoolArray
    raise_measure: FloatArray
    torso_px: FloatArray = None  # type: ignore[assignment]  # NaN takes its place
    refusal: IntArray = None  # type: ignore[assignment]  # 0 takes its place
    seated: FloatArray = None  # type: ignore[assignment]  # NaN takes its place
    gesture: IntArray = None  # type: ignore[assignment]  # 0 takes its place
    wrist_only: BoolArray = None  # type: ignore[assignment]  # False takes its place

    def __post_init__(self) -> None:
        count = len(self.landmarks_px)
        unknown: dict[str, NDArray[Any]] = {
            "torso_px": np.full((count, 2), np.nan),
            "seated": np.full(count, np.nan),
            "refusal": np.zeros(count, np.int64),
            "gesture": np.zeros(count, np.int64),
            "wrist_only": np.zeros(count, np.bool_),
        }
        for name, value in unknown.items():
            if getattr(self, name) is None:
                object.__setattr__(self, name, value)
        check_rows(self, count, _LAYOUT)

    def __len__(self) -> int:
        return len(self.score)

    def __getitem__(self, rows: Any) -> Hands:
        return select(self, rows)

    @staticmethod
    def none() -> Hands:
        """No hand at all."""
        nothing = np.zeros(0)
        return Hands(np.zeros((0, 21, 2)), nothing, nothing, nothing.astype(bool), nothing)

    @staticmethod
    def concatenate(*parts: Hands) -> Hands:
        """Join batches of one image, rows in the order given."""
        return Hands(
            **{
                item.name: np.concatenate([getattr(part, item.name) for part in parts])
                for item in fields(Hands)
            }
        )

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
