"""What map would a robot have made of a room? Walls and tables; chairs are moved all day."""

from __future__ import annotations

import cv2
import numpy as np

from tracker.containers import FloatArray, OccupancyGrid
from tracker.containers.occupancy_grid import UNKNOWN
from tracker.simulation.legs import table_posts
from tracker.simulation.scene import Scene

_RESOLUTION_M = 0.05
#: The map reaches so far beyond what is in it.
_MARGIN_M = 1.0
#: A larger room is mapped in larger cells.
_MAX_CELLS = 4_000_000
#: What passes within this share of a cell's side from its middle takes the cell.
_TOUCHES = 0.6


def floor_map(scene: Scene) -> OccupancyGrid:
    """The map of a scene in the frame `map`, at the height of its laser.

    What the robot can reach from its way is free, what it can never see into is unknown.
    """
    walls = np.array(
        [part for wall in scene.walls if wall.height_m > scene.laser.z_m for part in wall.segments]
    ).reshape(-1, 4)
    posts = np.array([post for table in scene.tables for post in table_posts(table)])
    posts = posts.reshape(-1, 3)
    drive = np.array([(point.x_m, point.y_m) for point in scene.robot.path])
    known = np.concatenate([walls[:, :2], walls[:, 2:], posts[:, :2], drive])
    low_m = known.min(axis=0) - _MARGIN_M
    size_m = known.max(axis=0) + _MARGIN_M - low_m
    resolution_m = max(_RESOLUTION_M, float(np.sqrt(size_m.prod() / _MAX_CELLS)))
    columns, rows = np.ceil(size_m / resolution_m).astype(int)
    taken = np.zeros((rows, columns), bool)
    reach_m = _TOUCHES * resolution_m
    for x_m, y_m, radius_m in posts:
        ends = np.array([[x_m, y_m], [x_m, y_m]])
        _take(taken, (ends - low_m) / resolution_m, (radius_m + reach_m) / resolution_m)
    for wall in walls:
        _take(taken, (wall.reshape(2, 2) - low_m) / resolution_m, reach_m / resolution_m)
    cells = np.where(taken, 100, UNKNOWN).astype(np.int8)
    _, regions = cv2.connectedComponents((~taken).astype(np.uint8), connectivity=4)
    column, row = ((drive - low_m) / resolution_m).astype(int).T
    reached = np.setdiff1d(regions[row, column], [0])  # 0 is what is taken
    cells[np.isin(regions, reached)] = 0
    origin = (float(low_m[0]), float(low_m[1]), 0.0)
    return OccupancyGrid(scene.start_s * 1_000_000_000, "map", resolution_m, origin, cells)


def _take(taken: np.ndarray, ends: FloatArray, reach: float) -> None:
    """Mark the cells whose middles are near to a straight piece; all in cells from the corner."""
    first = np.maximum(np.floor(ends.min(axis=0) - reach).astype(int), 0)
    last = np.minimum(np.ceil(ends.max(axis=0) + reach).astype(int), taken.shape[::-1])
    column, row = np.meshgrid(np.arange(first[0], last[0]), np.arange(first[1], last[1]))
    middle = np.stack([column + 0.5, row + 0.5], axis=-1)
    span = ends[1] - ends[0]
    length = float(span @ span)
    share = np.clip((middle - ends[0]) @ span / length, 0.0, 1.0) if length else 0.0
    away = middle - ends[0] - np.multiply.outer(share, span)
    taken[first[1] : last[1], first[0] : last[0]] |= np.hypot(away[..., 0], away[..., 1]) <= reach
