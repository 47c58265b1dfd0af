"""One image as the models see it: cleared, tinted where it is gray, and what has moved in it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from tracker.containers import FloatArray, ImageArray
from tracker.perception.hands.gray import tint_gray
from tracker.perception.movement import Movement


@dataclass(eq=False)
class SeenPicture:
    """Each part is made once, for the first who asks.

    Attributes:
        bgr: Shape (height, width, 3): what landmarks are read from.
        movement: Knows the picture before.
    """

    bgr: ImageArray
    movement: Movement

    @cached_property
    def tinted_bgr(self) -> ImageArray:
        """Shape (height, width, 3): what is searched for palms and people."""
        return tint_gray(self.bgr)

    @cached_property
    def moved_px(self) -> FloatArray:
        """Boxes as of `Movement.boxes`, shape (M, 4)."""
        return self.movement.boxes(self.tinted_bgr)
