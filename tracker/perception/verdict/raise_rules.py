"""When is a hand up? The specification's rule in shares of the image, and one in palm lengths."""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, IntArray, Refusal

WRIST, THUMB_TIP, MIDDLE_ROOT, MIDDLE_TIP, PINKY_TIP = 0, 4, 9, 12, 20
#: A palm that was up stays up above so many palm lengths and until it leans so far: single bounds
#: would flicker.
PALM_LOWERED, LOWERED_LEAN_DEG = 0.9, 50.0

#: What `Hands.raise_measure` is measured in, by `raise_rule`.
MEASURE_UNITS = {"evidence": "sure", "palm": "palms", "image": "image heights"}


def judge_raised(
    landmarks_px: FloatArray,
    image_size: tuple[int, int],
    config: Config,
    was_raised: BoolArray | None = None,
) -> tuple[BoolArray, FloatArray]:
    """Apply the configured rule to every hand of an image.

    Args:
        landmarks_px: Shape (H, 21, 2): x to the right, y down.
        image_size: Width and height in the same pixels.
        config: `raise_rule` and the thresholds that it needs.
        was_raised: Shape (H,): hands that were up in the image before, for the palm rule; None
            means that nobody knows.

    Returns:
        Verdict of shape (H,), and the measure of shape (H,) that was compared with the threshold.
    """
    if config.raise_rule == "image":
        return image_rule(
            landmarks_px, image_size, config.hand_raised_threshold, config.hand_span_threshold
        )
    stays = np.zeros(len(landmarks_px), dtype=bool) if was_raised is None else was_raised
    rise, lean_deg = config.palm_raised_threshold, config.raised_lean_max_deg
    rise_min = np.where(stays, min(rise, PALM_LOWERED), rise)
    lean_max_rad = np.radians(np.where(stays, max(lean_deg, LOWERED_LEAN_DEG), lean_deg))
    return palm_rule(landmarks_px, rise_min, lean_max_rad)


def rule_refusals(rises: BoolArray, measure: FloatArray, config: Config) -> IntArray:
    """Why the configured rule does not call hands raised, shape (H,): of `Refusal`.

    Args:
        rises: Shape (H,): as from `judge_raised`, like `measure`.
        measure: Shape (H,).
        config: `raise_rule` and its threshold.
    """
    threshold, otherwise = config.palm_raised_threshold, Refusal.LEANS
    if config.raise_rule == "image":
        threshold, otherwise = config.hand_raised_threshold, Refusal.CLOSED
    refusal = np.where(measure > threshold, otherwise, Refusal.NOT_UP)
    return np.where(rises, Refusal.NO_REASON, refusal).astype(np.int64)


def image_rule(
    landmarks_px: FloatArray,
    image_size: tuple[int, int],
    raised_threshold: float,
    span_threshold: float,
) -> tuple[BoolArray, FloatArray]:
    """The specification's algorithm 3: an upright hand that fills enough of the image.

    Raised where (wrist.y - middle_tip.y) / height > `raised_threshold` and
    |thumb_tip.x - pinky_tip.x| / width > `span_threshold`. With the defaults and a focal length of
    460 px that reaches to about 0.7 m.

    Returns:
        Verdict and vertical distance in image heights, each of shape (H,).
    """
    width, height = image_size
    up = _rise_px(landmarks_px) / height
    span = np.abs(landmarks_px[:, THUMB_TIP, 0] - landmarks_px[:, PINKY_TIP, 0]) / width
    return (up > raised_threshold) & (span > span_threshold), up


def palm_rule(
    landmarks_px: FloatArray, rise_min: float | FloatArray, lean_max_rad: float | FloatArray
) -> tuple[BoolArray, FloatArray]:
    """The rule `palm`, for every distance: the rise in palm lengths.

    Raised where (wrist.y - middle_tip.y) / |wrist - middle finger's root| > `rise_min` and the
    hand leans no farther than `lean_max_rad` to a side: an arm that swings down passes through a
    long hand that still rises, but lies on its side. Open hands that point up measure 1.6-2.4,
    fists about 0.8; how far three or four fingers are spread tells nothing.

    Args:
        landmarks_px: Shape (H, 21, 2).
        rise_min: In palm lengths, for all or for each, shape (H,).
        lean_max_rad: Likewise, of the line from wrist to middle finger's tip, from upright.

    Returns:
        Verdict and rise in palm lengths, each of shape (H,); a palm without length measures 0.
    """
    palm = np.linalg.norm(landmarks_px[:, MIDDLE_ROOT] - landmarks_px[:, WRIST], axis=-1)
    rise = _rise_px(landmarks_px)
    up = np.divide(rise, palm, out=np.zeros(len(palm)), where=palm > 0.0)
    aside = np.abs(landmarks_px[:, MIDDLE_TIP, 0] - landmarks_px[:, WRIST, 0])
    return (up > rise_min) & (np.arctan2(aside, rise) <= lean_max_rad), up


def _rise_px(landmarks_px: FloatArray) -> FloatArray:
    return np.asarray(landmarks_px[:, WRIST, 1] - landmarks_px[:, MIDDLE_TIP, 1], np.float64)
