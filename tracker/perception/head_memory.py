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

    A hand that was at the head beyond doubt of late must get well clear of it, by the measure of
    that head's body if another one, which seems smaller, is taken for the owner now. It stays at
    the head while nobody knows whose it is. One within its own length of that hand's place is the
    same.
    """

    _wrist_px: FloatArray
    _shoulder_px: FloatArray
    _stamp_ns: IntArray

    def __init__(self) -> None:
        self.reset()

    def judge(
        self,
        stamp_ns: int,
        hands: Hands,
        bodies: Bodies,
        owner: IntArray,
        clearance_shoulders: float | FloatArray,
    ) -> BoolArray:
        """Hands at their owner's head.

        Args:
            stamp_ns: Of the image.
            hands: As for `hands_at_head`, like all that follow.
            bodies: Who is there.
            owner: Shape (H,): rows of `bodies`, or -1.
            clearance_shoulders: For hands that were not at the head of late; as there.

        Returns:
            Shape (H,).
        """
        passed_ns = stamp_ns - self._stamp_ns
        is_kept = (passed_ns >= 0) & (passed_ns <= _REMEMBERED_S * 1e9)
        wrist_px, shoulder_px = self._wrist_px[is_kept], self._shoulder_px[is_kept]
        apart_px = np.linalg.norm(hands.wrist_px[:, None] - wrist_px[None], axis=-1)
        is_same = apart_px < hands.length_px[:, None]
        was_at_head = is_same.any(axis=1)
        width_px = np.where(is_same, shoulder_px, 0.0).max(axis=1, initial=0.0)
        beside = owners_by_head(hands, bodies, owner)
        own_px = np.append(bodies.shoulder_px, np.inf)[beside]
        wider = np.maximum(width_px / own_px, 1.0)
        clearance = clearance_shoulders * np.where(was_at_head, _CLEAR_AGAIN * wider, 1.0)
        is_sure = hands_at_head(hands, bodies, beside, _BEYOND_DOUBT * clearance_shoulders)
        is_unknown = was_at_head & (owner < 0)
        now_px = np.where(is_sure, own_px, width_px)[is_sure | is_unknown]
        is_sure |= is_unknown
        self._wrist_px = np.concatenate([wrist_px, hands.wrist_px[is_sure]])
        self._shoulder_px = np.append(shoulder_px, now_px)
        self._stamp_ns = np.append(self._stamp_ns[is_kept], np.full(is_sure.sum(), stamp_ns))
        return is_sure | hands_at_head(hands, bodies, beside, clearance)

    def reset(self) -> None:
        """Forget all hands."""
        self._wrist_px = np.zeros((0, 2))
        self._shoulder_px = np.zeros(0)
        self._stamp_ns = np.zeros(0, dtype=np.int64)
