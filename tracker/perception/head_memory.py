"""Is this hand at its owner's head, and was it a moment ago?

Whether a hand is at the head is measured anew in each image, against a body that was seen up to a
second ago. Where the cup goes down the answer would flicker, and two images in a row make a raised
hand.
"""

from __future__ import annotations

import numpy as np

from tracker.containers import BoolArray, FloatArray, Hands, IntArray
from tracker.perception.bodies import Bodies
from tracker.perception.pose_rules import hands_at_head, owners_by_head

#: A hand nearer than this is at the head beyond doubt, in shares of the clearance ...
_BEYOND_DOUBT = 0.8
#: ... and must get so far from it before it is clear again (guesses).
_CLEAR_AGAIN = 1.25
#: For so long; as long as a body's pose counts.
_REMEMBERED_S = 1.0


class HeadMemory:
    """Judges the hands of one image after the other, as `hands_at_head` does one image's.

    A hand that was at the head beyond doubt of late must get well clear of it, and stays at it
    while nobody knows whose it is. One within its own length of that hand's place is the same.
    """

    _wrist_px: FloatArray
    _stamp_ns: IntArray

    def __init__(self) -> None:
        self.reset()

    def judge(
        self,
        stamp_ns: int,
        hands: Hands,
        bodies: Bodies,
        owner: IntArray,
        clearance_shoulders: float,
    ) -> BoolArray:
        """Hands at their owner's head.

        Args:
            stamp_ns: Of the image.
            hands: As for `hands_at_head`, like all that follow.
            bodies: Who is there.
            owner: Shape (H,): rows of `bodies`, or -1.
            clearance_shoulders: For hands that were not at the head of late.

        Returns:
            Shape (H,).
        """
        passed_ns = stamp_ns - self._stamp_ns
        is_kept = (passed_ns >= 0) & (passed_ns <= _REMEMBERED_S * 1e9)
        wrist_px, stamps_ns = self._wrist_px[is_kept], self._stamp_ns[is_kept]
        apart_px = np.linalg.norm(hands.wrist_px[:, None] - wrist_px[None], axis=-1)
        was_at_head = (apart_px < hands.length_px[:, None]).any(axis=1)
        clearance = clearance_shoulders * np.where(was_at_head, _CLEAR_AGAIN, 1.0)
        beside = owners_by_head(hands, bodies, owner)
        is_sure = hands_at_head(hands, bodies, beside, _BEYOND_DOUBT * clearance_shoulders)
        is_sure |= was_at_head & (owner < 0)
        self._wrist_px = np.concatenate([wrist_px, hands.wrist_px[is_sure]])
        self._stamp_ns = np.append(stamps_ns, np.full(is_sure.sum(), stamp_ns))
        return is_sure | hands_at_head(hands, bodies, beside, clearance)

    def reset(self) -> None:
        """Forget all hands."""
        self._wrist_px = np.zeros((0, 2))
        self._stamp_ns = np.zeros(0, dtype=np.int64)
