"""Where should the robot look and drive? Poses of customers, as they face each other."""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import Caller, FloatArray, Pose, Tracks
from tracker.geometry import euler_to_quaternion, facing_yaw, worst_std


def customer_pose(
    tracks: Tracks, robot_xy_m: FloatArray, frame_id: str, config: Config
) -> Pose | None:
    """The selected customer, facing the robot (equations 5 to 10, in the fixed frame).

    Args:
        tracks: All customers.
        robot_xy_m: Shape (2,): the camera in the fixed frame.
        frame_id: Name of the fixed frame.
        config: `pose_max_std_m` and `pose_max_age_s`.

    Returns:
        None when nobody is selected, or the estimate is too old or too uncertain to drive to.
    """
    row = tracks.row_of(tracks.selected_id)
    if row is None or tracks.unseen_s[row] > config.pose_max_age_s:
        return None
    covariance = tracks.covariance[row, :2, :2]
    if worst_std(covariance) > config.pose_max_std_m:
        return None
    return _facing(tracks.mean[row, :2], covariance.copy(), tracks.stamp_ns, robot_xy_m, frame_id)


def call_pose(caller: Caller, stamp_ns: int, robot_xy_m: FloatArray, frame_id: str) -> Pose:
    """Somebody on the waiting list, at the place where they were last seen, facing the robot.

    Args:
        caller: From a `WaitingList`.
        stamp_ns: This frame's.
        robot_xy_m: Shape (2,): the camera in the fixed frame.
        frame_id: Name of the fixed frame.
    """
    xx, xy, yy = caller.covariance_m2
    covariance = np.array([[xx, xy], [xy, yy]])
    return _facing(np.array(caller.xy_m), covariance, stamp_ns, robot_xy_m, frame_id)


def approach_pose(customer: Pose, robot_xy_m: FloatArray, approach_distance_m: float) -> Pose:
    """In front of a customer, on the robot's side, facing the customer.

    Args:
        customer: From `customer_pose`.
        robot_xy_m: Shape (2,): the camera in the fixed frame.
        approach_distance_m: How far from the customer.
    """
    xy = np.array(customer.position_m[:2])
    offset = xy - robot_xy_m
    heading = float(np.arctan2(offset[1], offset[0]))
    x, y = xy - approach_distance_m * np.array([np.cos(heading), np.sin(heading)])
    return Pose(
        customer.stamp_ns,
        customer.frame_id,
        (float(x), float(y), 0.0),
        euler_to_quaternion(0.0, 0.0, heading),
        customer.covariance_m2,
    )


def _facing(
    xy_m: FloatArray,
    covariance_m2: FloatArray,
    stamp_ns: int,
    robot_xy_m: FloatArray,
    frame_id: str,
) -> Pose:
    x, y = xy_m
    yaw = facing_yaw(x - robot_xy_m[0], y - robot_xy_m[1])
    turned = euler_to_quaternion(0.0, 0.0, yaw)
    return Pose(stamp_ns, frame_id, (float(x), float(y), 0.0), turned, covariance_m2)
