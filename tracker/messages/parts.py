"""What do many ROS messages consist of? Header, point, pose."""

from __future__ import annotations

from typing import Any

from tracker.errors import RecordingError
from tracker.messages.types import build


def header(stamp_ns: int, frame_id: str) -> Any:
    """A std_msgs/Header.

    Raises:
        RecordingError: The stamp does not fit into 32 bits of seconds.
    """
    sec, nanosec = divmod(int(stamp_ns), 1_000_000_000)
    if not 0 <= sec < 2**31:
        raise RecordingError(
            f"A stamp of {stamp_ns} ns came; ROS messages hold 0 to {2**31 - 1} seconds."
        )
    time = build("builtin_interfaces/msg/Time", sec=sec, nanosec=nanosec)
    return build("std_msgs/msg/Header", stamp=time, frame_id=frame_id)


def point(x: float, y: float, z: float, kind: str = "Point") -> Any:
    """A geometry_msgs/Point, or Vector3 by `kind`."""
    return build(f"geometry_msgs/msg/{kind}", x=float(x), y=float(y), z=float(z))


def ros_pose(
    position_m: tuple[float, float, float],
    quaternion_xyzw: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0),
) -> Any:
    """A geometry_msgs/Pose."""
    return build(
        "geometry_msgs/msg/Pose", position=point(*position_m), orientation=turn(quaternion_xyzw)
    )


def turn(quaternion_xyzw: tuple[float, float, float, float]) -> Any:
    """A geometry_msgs/Quaternion."""
    x, y, z, w = (float(value) for value in quaternion_xyzw)
    return build("geometry_msgs/msg/Quaternion", x=x, y=y, z=z, w=w)
