"""Which arms are up? What `detector: pose` asks of a body alone."""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray, FloatArray
from tracker.perception.bodies import SHOULDERS, WRISTS, Bodies
from tracker.perception.verdict.owners import head_distance_px


def judge_arms(bodies: Bodies, config: Config) -> tuple[BoolArray, FloatArray]:
    """Arms whose wrist is well above the shoulder, and not at the head.

    A hand that holds a telephone, drinks or scratches has its wrist above the shoulder too, but
    close to the face.

    Args:
        bodies: Who is there.
        config: `pose_raised_threshold` and `pose_head_clearance`.

    Returns:
        Verdict and rise of the wrist above the shoulder in widths of the shoulders, each of shape
        (P, 2), left arm first; an arm that is not seen is down and measures NaN.
    """
    seen, points = bodies.is_visible, bodies.points_px
    width = bodies.shoulder_px[:, None]
    rise_px = points[:, SHOULDERS, 1] - points[:, WRISTS, 1]
    rise = np.where(seen[:, SHOULDERS] & seen[:, WRISTS], rise_px / width, np.nan)
    head_px = np.stack([head_distance_px(bodies, points[:, wrist]) for wrist in WRISTS], axis=-1)
    is_clear = ~(head_px < config.pose_head_clearance * width)
    return (rise > config.pose_raised_threshold) & is_clear, rise
