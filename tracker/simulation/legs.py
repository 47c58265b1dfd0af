"""Where does furniture touch the floor? Its legs as circles, as a laser at shin height meets them.

Thicknesses are guesses at ordinary furniture.
"""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray
from tracker.simulation.interior import Chair, Pose2, Table

_LEG_RADIUS_M = 0.03
_PEDESTAL_RADIUS_M = 0.06
#: Of tables with two posts: their thickness, and how far they are from the table's short sides.
_POST_RADIUS_M, _POST_INSET_M = 0.04, 0.15
_LEG_INSET_M = 0.05
#: Half the distance between the legs of a chair, and their thickness; a bar stool has one column.
CHAIR_HALF_M, _CHAIR_LEG_RADIUS_M, _COLUMN_RADIUS_M = 0.19, 0.018, 0.03


def table_posts(table: Table) -> FloatArray:
    """Shape (1, 2 or 4, 3): x_m, y_m, radius_m of a table's posts in the map."""
    if table.posts == 1:
        return np.array([[table.x_m, table.y_m, _PEDESTAL_RADIUS_M]])
    if table.posts == 2:
        along = max(table.length_m / 2 - _POST_INSET_M, table.length_m / 4)
        return _circles(table, np.array([[along, 0.0], [-along, 0.0]]), _POST_RADIUS_M)
    along, across = table.length_m / 2 - _LEG_INSET_M, table.width_m / 2 - _LEG_INSET_M
    if table.round:  # within the circle
        along, across = along / np.sqrt(2.0), across / np.sqrt(2.0)
    own = np.array([[along, across], [along, -across], [-along, -across], [-along, across]])
    return _circles(table, own, _LEG_RADIUS_M)


def chair_legs(chair: Chair) -> FloatArray:
    """Shape (1 or 4, 3): x_m, y_m, radius_m of the legs of a chair or stool in the map."""
    if chair.kind == "bar_stool":
        return np.array([[chair.x_m, chair.y_m, _COLUMN_RADIUS_M]])
    corners = np.array([[1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]])
    return _circles(chair, CHAIR_HALF_M * corners, _CHAIR_LEG_RADIUS_M)


def in_map(pose: Pose2, own_m: FloatArray) -> FloatArray:
    """Points of a thing's own axes, shape (..., 2), in the map."""
    yaw = np.radians(pose.yaw_deg)
    turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
    return np.asarray(own_m @ turn.T + (pose.x_m, pose.y_m))


def _circles(pose: Pose2, own_m: FloatArray, radius_m: float) -> FloatArray:
    return np.column_stack([in_map(pose, own_m), np.full(len(own_m), radius_m)])
