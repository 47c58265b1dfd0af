"""What do RViz and Foxglove show of the customers? A body, a label and an ellipse for each."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray, Pose, Tracks
from tracker.geometry import euler_to_quaternion
from tracker.messages.parts import header, point, ros_pose
from tracker.messages.types import MARKER_ARRAY, Encoded, build, serialize

# visualization_msgs/Marker.
_ARROW, _CYLINDER, _TEXT = 0, 3, 9
_ADD, _DELETE_ALL = 0, 3

_LOWERED, _RAISED, _SELECTED = (0.45, 0.55, 0.65), (1.0, 0.6, 0.1), (0.15, 0.8, 0.3)

#: 95 % quantile of chi-square with two degrees of freedom: -2 ln(0.05).
_CHI2_95 = 5.991


def encode_markers(
    tracks: Tracks, *, frame_id: str = "map", approach: Pose | None = None
) -> Encoded:
    """Draw the customers as a visualization_msgs/MarkerArray.

    Each person is a cylinder (orange with a raised hand, green when selected, gray otherwise, pale
    until confirmed), a label and the 95 % ellipse of the position on the floor. The first marker
    deletes all that were there before, so nobody lingers.

    Args:
        tracks: The customers.
        frame_id: Their fixed frame.
        approach: Where the robot would stand, as an arrow.
    """
    stamp = header(tracks.stamp_ns, frame_id)
    markers = [build("visualization_msgs/msg/Marker", header=stamp, action=_DELETE_ALL)]

    def add(name: str, number: int, kind: int, **fields: object) -> None:
        markers.append(
            build(
                "visualization_msgs/msg/Marker",
                header=fields.pop("header", stamp),
                ns=name,
                id=number % 2**31,
                type=kind,
                action=_ADD,
                **fields,
            )
        )

    for row in range(len(tracks)):
        number, (x, y) = int(tracks.id[row]), tracks.mean[row, :2]
        is_selected = number == tracks.selected_id
        color = _SELECTED if is_selected else _RAISED if tracks.raised[row] else _LOWERED
        alpha = 0.8 if tracks.confirmed[row] else 0.3
        add(
            "people", number, _CYLINDER,
            pose=ros_pose((x, y, 0.85)), scale=_size(0.4, 0.4, 1.7), color=_color(color, alpha),
        )  # fmt: skip
        hand = "hand up" if tracks.raised[row] else "hand down"
        served = ", served" if is_selected else ""
        add(
            "labels", number, _TEXT,
            pose=ros_pose((x, y, 2.0)), scale=_size(0.0, 0.0, 0.25), color=_color((1.0, 1.0, 1.0)),
            text=f"#{number} {hand}{served} ({tracks.existence[row]:.2f})",
        )  # fmt: skip
        length, width, yaw = ellipse(tracks.covariance[row, :2, :2])
        add(
            "ellipses", number, _CYLINDER,
            pose=ros_pose((x, y, 0.01), euler_to_quaternion(0.0, 0.0, yaw)),
            scale=_size(length, width, 0.02), color=_color(color, 0.4),
        )  # fmt: skip
    if approach is not None:
        add(
            "approach", 0, _ARROW,
            header=header(approach.stamp_ns, approach.frame_id),
            pose=ros_pose(approach.position_m, approach.quaternion_xyzw),
            scale=_size(0.5, 0.08, 0.08), color=_color(_SELECTED),
        )  # fmt: skip
    return serialize(build(MARKER_ARRAY, markers=markers))


def ellipse(covariance: FloatArray) -> tuple[float, float, float]:
    """The 95 % ellipse of a position.

    Args:
        covariance: Shape (2, 2), square meters.

    Returns:
        Length of the long axis and of the short one in meters (never zero, which RViz refuses),
        and the long axis' direction in radians.
    """
    values, vectors = np.linalg.eigh(covariance)
    short, long = 2.0 * np.sqrt(_CHI2_95 * np.maximum(values, 1e-8))
    return float(long), float(short), float(np.arctan2(vectors[1, 1], vectors[0, 1]))


def _size(x: float, y: float, z: float) -> object:
    return point(x, y, z, "Vector3")


def _color(rgb: tuple[float, float, float], alpha: float = 1.0) -> object:
    red, green, blue = rgb
    return build("std_msgs/msg/ColorRGBA", r=red, g=green, b=blue, a=alpha)
