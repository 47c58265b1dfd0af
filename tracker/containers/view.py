"""What could a sensor see in one frame?"""

from __future__ import annotations

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

    @staticmethod
    def between(
        sensor_pose: FloatArray, first_rad: float, last_rad: float, range_max_m: float = np.inf
    ) -> View:
        """The view between two bearings of the sensor's frame, from the right to the left."""
        turned = np.array(sensor_pose, dtype=np.float64)
        turned[2] += (first_rad + last_rad) / 2.0
        return View(turned, last_rad - first_rad, range_max_m)
