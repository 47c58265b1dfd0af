"""What would a sensor measure of somebody? Bearing and range, and how they turn with the place."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray

#: Nearer than this to the sensor a bearing turns too fast to be linear.
RANGE_FLOOR_M = 0.1


def expect_polar(mean: FloatArray, sensor_pose: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Bearing and range of people from a sensor.

    Args:
        mean: Shape (..., 4); only x and y count.
        sensor_pose: Shape (..., 3): x_m, y_m, yaw_rad, broadcast against `mean`.

    Returns:
        Bearing (not normalized) and range, shape (..., 2), and their derivatives by x and y, shape
        (..., 2, 2).
    """
    offset = mean[..., :2] - sensor_pose[..., :2]
    dx, dy = offset[..., 0], offset[..., 1]
    range_m = np.maximum(np.hypot(dx, dy), RANGE_FLOOR_M)
    expected = np.empty(offset.shape)
    expected[..., 0] = np.arctan2(dy, dx) - sensor_pose[..., 2]
    expected[..., 1] = range_m
    jacobian = np.empty((*offset.shape, 2))
    cos, sin = dx / range_m, dy / range_m
    jacobian[..., 0, 0], jacobian[..., 0, 1] = -sin / range_m, cos / range_m
    jacobian[..., 1, 0], jacobian[..., 1, 1] = cos, sin
    return expected, jacobian


def expect_cartesian(mean: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The position itself, shape (..., 2), and its derivative, the identity."""
    return mean[..., :2], np.broadcast_to(np.eye(2), (*mean.shape[:-1], 2, 2))


def pose_noise(jacobian: FloatArray, sensor_pose_covariance: FloatArray) -> FloatArray:
    """Covariance that the sensor's own pose adds to a bearing and a range, shape (..., 2, 2).

    A sensor that moves by (dx, dy) is a person who moves by (-dx, -dy); a sensor that turns takes
    its turn off the bearing. The error is taken for independent from measurement to measurement,
    although all those of one frame share it: the tracks' covariances are right one by one, their
    correlation is not kept.

    Args:
        jacobian: Shape (..., 2, 2), from `expect_polar`.
        sensor_pose_covariance: Shape (..., 3, 3), of x_m, y_m, yaw_rad.
    """
    by_pose = np.zeros((*jacobian.shape[:-1], 3))
    by_pose[..., :2] = -jacobian
    by_pose[..., 0, 2] = -1.0
    return np.asarray(by_pose @ sensor_pose_covariance @ np.swapaxes(by_pose, -1, -2))
