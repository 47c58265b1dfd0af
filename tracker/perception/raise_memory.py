"""Is a followed hand up? The raise rule with hysteresis, and patience with small hands."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, IntArray, Refusal
from tracker.perception.landmarks import Landmarks
from tracker.perception.raise_rules import (
    MIDDLE_TIP,
    WRIST,
    judge_raised,
    palm_rule,
    rule_refusals,
)

_NEVER_NS = np.iinfo(np.int64).max


class Verdict(NamedTuple):
    """What the rule says about the hands of an image.

    Attributes:
        raised: Shape (H,).
        measure: Shape (H,): what was compared with the threshold.
        pending: Shape (H,); see `Hands.pending`.
        refusal: Shape (H,): of `Refusal`, for those not raised.
    """

    raised: BoolArray
    measure: FloatArray
    pending: BoolArray
    refusal: IntArray


class RaiseMemory:
    """Judges the hands of one image after the other; the specification's rule needs no memory.

    A hand goes up by `palm_raised_threshold`, upright and with a sure landmark score, and stays up
    while it keeps to the milder bounds: single ones would flicker. What looks like
    a small raised hand for a frame is often none, so that a small one counts once it has been up
    for `small_hand_patience_s`. Until then, and while its score is unsure, it is pending: the
    body whose hand it is may know.
    """

    def __init__(self) -> None:
        self._up_since_ns = np.zeros(0, dtype=np.int64)
        self._rose = np.zeros(0, dtype=bool)

    def judge(
        self,
        stamp_ns: int,
        hands: Landmarks,
        last_rows: IntArray,
        image_size: tuple[int, int],
        config: Config,
    ) -> Verdict:
        """Verdict on each hand.

        Args:
            stamp_ns: Of the image.
            hands: Everybody's.
            last_rows: Shape (H,): the row of each in the last call; -1 for new hands.
            image_size: Width and height in pixels.
            config: The raise rule and its thresholds.
        """
        points = hands.points_px
        rises, measure = judge_raised(points, image_size, config)
        refusal = rule_refusals(rises, measure, config)
        if config.raise_rule == "image":
            self._up_since_ns = np.full(len(hands), _NEVER_NS)
            self._rose = np.zeros(len(hands), dtype=bool)
            return Verdict(rises, measure, self._rose, refusal)
        lean_max_rad = np.radians(config.lowered_lean_min_deg)
        stays, _ = palm_rule(points, config.palm_lowered_threshold, lean_max_rad)
        since_ns = np.append(self._up_since_ns, _NEVER_NS)[last_rows]  # row -1 has never been up
        is_sure = hands.score >= config.raised_score_min
        is_up = np.where(since_ns < _NEVER_NS, stays, rises & is_sure)
        self._up_since_ns = np.where(is_up, np.minimum(since_ns, stamp_ns), _NEVER_NS)
        length = np.linalg.norm(points[:, MIDDLE_TIP] - points[:, WRIST], axis=-1)
        patience_s = np.where(length < config.small_hand_px, config.small_hand_patience_s, 0.0)
        raised = is_up & (stamp_ns - self._up_since_ns >= patience_s * 1e9)
        self._rose = np.where(np.append(self._rose, False)[last_rows], stays, rises)
        refusal = np.where(rises & ~is_up, Refusal.UNSURE, refusal)
        refusal = np.where(is_up, np.where(raised, 0, Refusal.TOO_BRIEF), refusal)
        return Verdict(raised, measure, self._rose & ~raised, refusal)

    def reset(self) -> None:
        """Forget all hands."""
        self._up_since_ns = np.zeros(0, dtype=np.int64)
        self._rose = np.zeros(0, dtype=bool)
