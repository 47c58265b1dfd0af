"""Whom could the sensors see at all? Field of view, range, and people who stand in front."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.containers import FloatArray
from tracker.geometry import normalize_angle

#: Half a body: who stands this close to the line of sight covers it.
HALF_BODY_M = 0.2
#: A body with its arm: at the edge of the view part of it is seen.
ARM_M = 0.3
#: Somebody in front hides at least from this distance on; nearer they stand side by side.
DEPTH_MIN_M = 0.3
#: Share of the time that somebody behind another is seen nevertheless (guess).
OCCLUDED = 0.2


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """Where the sensor stood and what it could see, in one frame.

    Attributes:
        sensor_pose: Shape (3,): x_m, y_m, yaw_rad in the fixed frame.
        horizontal_fov_rad: Full width of the field of view; 2 pi or more is all around.
        range_max_m: Nobody farther off is detected.
    """

    sensor_pose: FloatArray
    horizontal_fov_rad: float
    range_max_m: float = np.inf

    @staticmethod
    def between(
        sensor_pose: FloatArray, first_rad: float, last_rad: float, range_max_m: float = np.inf
    ) -> View:
        """The view between two bearings of the sensor's frame, from the right to the left."""
        turned = np.array(sensor_pose, dtype=np.float64)
        turned[2] += (first_rad + last_rad) / 2.0
        return View(turned, last_rad - first_rad, range_max_m)


def visibility(xy_m: FloatArray, view: View | None) -> FloatArray:
    """Chance that nothing but the detector itself keeps people from being detected.

    Args:
        xy_m: Shape (N, 2), in the fixed frame.
        view: None means that everybody is in view.

    Returns:
        Shape (N,): 0 outside the field of view, between at its edge, little behind somebody else,
        1 in plain sight.
    """
    if view is None or len(xy_m) == 0:
        return np.ones(len(xy_m))
    offset = xy_m - view.sensor_pose[:2]
    range_m = np.maximum(np.hypot(offset[:, 0], offset[:, 1]), 0.1)
    bearing = np.arctan2(offset[:, 1], offset[:, 0])
    off_axis = np.abs(normalize_angle(bearing - view.sensor_pose[2]))
    inside = np.ones(len(xy_m))
    if view.horizontal_fov_rad < 2.0 * np.pi:
        # Whoever stands on the edge is half in view.
        reach = np.arctan2(ARM_M, range_m)
        inside = np.clip((view.horizontal_fov_rad / 2 - off_axis) / (2 * reach) + 0.5, 0.0, 1.0)
    inside = inside * (range_m <= view.range_max_m)
    half_width = HALF_BODY_M / range_m
    beside = np.abs(normalize_angle(bearing[:, None] - bearing))  # who, by whom
    hidden = (beside < half_width) & (range_m < range_m[:, None] - DEPTH_MIN_M)
    return inside * np.where(hidden.any(axis=1), OCCLUDED, 1.0)
