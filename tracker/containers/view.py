"""What could a sensor see in one frame?"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tracker.containers.arrays import FloatArray


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

    def covers(self, xy_m: tuple[float, float]) -> bool:
        """Whether a place in the fixed frame is within range and field of view."""
        x, y, yaw = self.sensor_pose
        offset = xy_m[0] - x, xy_m[1] - y
        off_axis_rad = math.remainder(math.atan2(offset[1], offset[0]) - yaw, math.tau)
        is_ahead = abs(off_axis_rad) <= self.horizontal_fov_rad / 2.0
        return is_ahead and math.hypot(*offset) <= self.range_max_m

    @staticmethod
    def between(
        sensor_pose: FloatArray, first_rad: float, last_rad: float, range_max_m: float = np.inf
    ) -> View:
        """The view between two bearings of the sensor's frame, from the right to the left."""
        turned = np.array(sensor_pose, dtype=np.float64)
        turned[2] += (first_rad + last_rad) / 2.0
        return View(turned, last_rad - first_rad, range_max_m)
