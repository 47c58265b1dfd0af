"""The waiting list as a ROS message: number, state, since when, pose and approach pose."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray, Tracks, WaitingList
from tracker.messages.parts import header
from tracker.messages.people import (
    YAW_OF_CALLER_RAD2,
    YAW_UNKNOWN_RAD2,
    hypothesis,
    person,
    pose_covariance,
)
from tracker.messages.types import DETECTIONS, Encoded, build, serialize
from tracker.service.poses import approach_pose, call_pose

#: The class under which a detection carries where the robot should stand.
APPROACH = "approach"


def encode_waiting_list(
    calls: WaitingList, *, frame_id: str, robot_xy_m: FloatArray, approach_distance_m: float
) -> Encoded:
    """Say who waits, as a vision_msgs/Detection3DArray in the order of service.

    The array bears the stamp of the image, each detection the stamp at which that person called;
    `id` is the number on the list. The first class is the state; `approach` has the pose at which
    the robot should stand; `selected`, `hand_raised`, `in_sight` and `track_7` stand there where
    that holds now. All poses but `approach` are the person's, facing the robot.

    Args:
        calls: The list.
        frame_id: The fixed frame.
        robot_xy_m: Shape (2,): the camera in the fixed frame.
        approach_distance_m: How far from the customer the robot should stand.
    """
    detections = []
    for caller in calls.callers:
        pose = call_pose(caller, calls.stamp_ns, robot_xy_m, frame_id)
        approach = approach_pose(pose, robot_xy_m, approach_distance_m)
        words = [caller.state.value]
        words += ["selected"] * (caller.id == calls.selected_id)
        words += ["hand_raised"] * caller.is_up
        if caller.track_id is not None:
            words += ["in_sight", f"track_{caller.track_id}"]
        said = person(
            track_id=caller.id,
            xy=caller.xy_m,
            covariance=pose_covariance(pose.covariance_m2, YAW_OF_CALLER_RAD2),
            words=words,
            score=1.0,
            stamp=header(caller.called_ns, frame_id),
            facing=pose.quaternion_xyzw,
        )
        spread = np.zeros((6, 6))
        spread[:2, :2] = pose.covariance_m2
        stand = hypothesis(APPROACH, 1.0, approach.position_m, spread, approach.quaternion_xyzw)
        said.results.append(stand)
        detections.append(said)
    return _array(calls.stamp_ns, frame_id, detections)


def encode_raised(tracks: Tracks, *, frame_id: str | None, is_on_floor: bool = True) -> Encoded:
    """Say whose hand is up, as a vision_msgs/Detection3DArray: `hand_raised` with a stamp.

    The array bears the stamp of the image, each detection the stamp at which that hand went up.

    Args:
        tracks: Everybody.
        frame_id: Their frame; None where it is unknown: nothing but identities is said then.
        is_on_floor: As of `encode_tracks`.
    """
    detections = []
    for row in np.flatnonzero(tracks.raised).tolist():
        said = person(
            track_id=int(tracks.id[row]),
            xy=tuple(tracks.mean[row, :2].tolist()),
            covariance=pose_covariance(
                tracks.covariance[row, :2, :2], YAW_UNKNOWN_RAD2, is_on_floor=is_on_floor
            ),
            words=["hand_raised"],
            score=float(tracks.existence[row]),
            stamp=header(int(tracks.raised_since_ns[row]), frame_id or ""),
        )
        if frame_id is None:
            said = build("vision_msgs/msg/Detection3D", header=said.header, results=[], id=said.id)
        detections.append(said)
    return _array(tracks.stamp_ns, frame_id or "", detections)


def _array(stamp_ns: int, frame_id: str, detections: list[object]) -> Encoded:
    stamp = header(stamp_ns, frame_id)
    return serialize(build(DETECTIONS, header=stamp, detections=detections))
