"""In which direction is somebody of whom the distance is unknown? Drawn as a fan, not a place."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray

#: A place is told where its standard deviation, along the worst axis, is below; elsewhere the
#: bearing alone. The default of `pose_max_std_m`.
PLACED_STD_M = 0.5
#: A fan is so wide at least, to be seen.
_LEAST_RAD = np.radians(1.0)


def direction(
    xy_m: FloatArray, covariance_m2: FloatArray, camera_xy_m: FloatArray
) -> tuple[float, float]:
    """Where somebody is, seen from the camera.

    Args:
        xy_m: Shape (2,), of the person.
        covariance_m2: Shape (2, 2), of that.
        camera_xy_m: Shape (2,), of the camera in the same frame.

    Returns:
        The bearing from the frame's x axis, and its standard deviation, in rad.
    """
    x, y = (xy_m - camera_xy_m).tolist()
    range_m = max(1e-6, float(np.hypot(x, y)))
    across = np.array([-y, x]) / range_m
    variance_m2 = max(0.0, float(across @ covariance_m2 @ across))
    return float(np.arctan2(y, x)), float(np.arctan2(variance_m2**0.5, range_m))


def fan(
    xy_m: FloatArray, covariance_m2: FloatArray, camera_xy_m: FloatArray
) -> tuple[float, float]:
    """The right and the left edge of a fan in rad, two standard deviations from the middle."""
    bearing_rad, std_rad = direction(xy_m, covariance_m2, camera_xy_m)
    half_rad = max(_LEAST_RAD, 2.0 * std_rad)
    return bearing_rad - half_rad, bearing_rad + half_rad
