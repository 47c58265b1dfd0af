"""How are people said in ROS? Each is a vision_msgs/Detection3D: words, place, covariance."""

from __future__ import annotations

from typing import Any

import numpy as np

from tracker.containers import FloatArray, Tracks, Truth
from tracker.gesture import Gesture
from tracker.messages.parts import header, point, ros_pose
from tracker.messages.types import DETECTIONS, Encoded, build, serialize

#: A person as a box: width and depth, height.
_BODY_WIDTH_M, _BODY_HEIGHT_M = 0.5, 1.7
#: How far the floor is from z = 0: in a room's frame, and in one at the camera's height (guess).
_FLOOR_STD_M, _CAMERA_HEIGHT_STD_M = 0.05, 1.0
#: How far people lean to each side (guess).
_LEAN_STD_RAD = 0.2

#: The yaw of somebody who may look anywhere: uniform over the circle.
YAW_UNKNOWN_RAD2 = np.pi**2 / 3
#: The yaw of somebody who calls the robot: uniform over the half circle towards it (guess).
YAW_OF_CALLER_RAD2 = np.pi**2 / 12


def encode_tracks(tracks: Tracks, *, frame_id: str, is_on_floor: bool = True) -> Encoded:
    """Say who is where, as a vision_msgs/Detection3DArray.

    The score of every class is the probability that the person exists. The first class is
    `hand_raised` or `hand_lowered`, and has the place with its covariance. Then come
    `customer/wave` where a gesture is known; `velocity`, whose position is in m/s, with the
    covariance of vx and vy; `age_s/12.300`, since the track began; and while the hand is up
    `raised_since/1700000000.123456789`, the stamp at which it went up.

    Args:
        tracks: Everybody.
        frame_id: Their frame.
        is_on_floor: z = 0 is the floor; else it is the camera's height, and the floor is unknown.

    Raises:
        RecordingError: A stamp does not fit into a message.
    """
    return serialize(tracks_message(tracks, frame_id, is_on_floor=is_on_floor))


def tracks_message(tracks: Tracks, frame_id: str, *, is_on_floor: bool = True) -> Any:
    """As `encode_tracks`, not yet serialized."""
    stamp = header(tracks.stamp_ns, frame_id)
    people = []
    for row in range(len(tracks)):
        score = float(tracks.existence[row])
        said = person(
            track_id=int(tracks.id[row]),
            xy=(float(tracks.mean[row, 0]), float(tracks.mean[row, 1])),
            covariance=pose_covariance(
                tracks.covariance[row, :2, :2], YAW_UNKNOWN_RAD2, is_on_floor=is_on_floor
            ),
            words=[*_hand_words(tracks, row), *_time_words(tracks, row)],
            score=score,
            stamp=stamp,
        )
        vx, vy = tracks.mean[row, 2:].tolist()
        spread = np.zeros((6, 6))
        spread[:2, :2] = tracks.covariance[row, 2:, 2:]
        said.results.append(hypothesis("velocity", score, (vx, vy, 0.0), spread))
        people.append(said)
    return build(DETECTIONS, header=stamp, detections=people)


def truth_message(truth: Truth, frame_id: str) -> Any:
    """Where simulated people really are, as a vision_msgs/Detection3DArray without covariance."""
    people = []
    for row in range(len(truth)):
        words = ["hand_raised" if truth.hand_up[row] else "hand_lowered"]
        people.append(
            person(
                track_id=int(truth.id[row]),
                xy=(float(truth.xy_m[row, 0]), float(truth.xy_m[row, 1])),
                covariance=np.zeros((6, 6)),
                words=[*words, "in_view"] if truth.in_view[row] else words,
                score=1.0,
                stamp=header(truth.stamp_ns, frame_id),
            )
        )
    return build(DETECTIONS, header=header(truth.stamp_ns, frame_id), detections=people)


def pose_covariance(
    covariance_m2: FloatArray, yaw_rad2: float, *, is_on_floor: bool = True
) -> FloatArray:
    """The covariance of a person's pose; of it x and y are estimated, the rest is what one knows.

    Args:
        covariance_m2: Shape (2, 2), of x and y.
        yaw_rad2: Variance of the direction in which the person looks.
        is_on_floor: As of `encode_tracks`.

    Returns:
        Shape (6, 6), of x, y, z in m and the rotations about x, y, z in rad.
    """
    spread = np.zeros((6, 6))
    spread[:2, :2] = covariance_m2
    spread[2, 2] = (_FLOOR_STD_M if is_on_floor else _CAMERA_HEIGHT_STD_M) ** 2
    spread[3, 3] = spread[4, 4] = _LEAN_STD_RAD**2
    spread[5, 5] = yaw_rad2
    return spread


def hypothesis(
    word: str,
    score: float,
    position: tuple[float, float, float],
    covariance: FloatArray,
    quaternion_xyzw: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0),
) -> Any:
    """A vision_msgs/ObjectHypothesisWithPose; its covariance has the shape (6, 6)."""
    return build(
        "vision_msgs/msg/ObjectHypothesisWithPose",
        hypothesis=build("vision_msgs/msg/ObjectHypothesis", class_id=word, score=score),
        pose=build(
            "geometry_msgs/msg/PoseWithCovariance",
            pose=ros_pose(position, quaternion_xyzw),
            covariance=covariance.reshape(-1),
        ),
    )


def person(
    *,
    track_id: int,
    xy: tuple[float, float],
    covariance: FloatArray,
    words: list[str],
    score: float,
    stamp: Any,
    facing: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0),
) -> Any:
    """One vision_msgs/Detection3D; the pose stands on the floor, the box around the body.

    All words share the pose and its covariance of shape (6, 6).
    """
    return build(
        "vision_msgs/msg/Detection3D",
        header=stamp,
        results=[hypothesis(word, score, (*xy, 0.0), covariance, facing) for word in words],
        bbox=build(
            "vision_msgs/msg/BoundingBox3D",
            center=ros_pose((*xy, _BODY_HEIGHT_M / 2)),
            size=point(_BODY_WIDTH_M, _BODY_WIDTH_M, _BODY_HEIGHT_M, "Vector3"),
        ),
        id=str(track_id),
    )


def _hand_words(tracks: Tracks, row: int) -> list[str]:
    words = ["hand_raised" if tracks.raised[row] else "hand_lowered"]
    gesture = Gesture(int(tracks.gesture[row]))
    return words if gesture is Gesture.NONE else [*words, f"customer/{gesture.word}"]


def _time_words(tracks: Tracks, row: int) -> list[str]:
    words = [f"age_s/{tracks.age_s[row]:.3f}"]
    if tracks.raised[row]:
        seconds, nanoseconds = divmod(int(tracks.raised_since_ns[row]), 1_000_000_000)
        words.append(f"raised_since/{seconds}.{nanoseconds:09d}")
    return words
