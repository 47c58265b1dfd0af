"""Is there furniture on the map? The distance of points to the nearest occupied cell."""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from tracker.containers import FloatArray, LocatedMap, OccupancyGrid
from tracker.containers.occupancy_grid import OCCUPIED_FROM, UNKNOWN
from tracker.geometry import RigidTransform

#: Mapped furniture shows up this many cells and meters beside its cells, at most (guess).
_REACH_CELLS, _REACH_M = 1.5, 0.1
#: Near an occupied cell a person-sized thing is so much more often furniture than a person (guess)
#: and elsewhere so much more seldom, since part of the furniture is on the map (guess).
_NEAR_ODDS, _FAR_ODDS = 20.0, 0.7


@dataclass(frozen=True, slots=True, eq=False)
class RoomMap:
    """A map with its distances, computed once by `RoomMap.of`.

    Attributes:
        distances_m: Shape (rows, columns), float32: from the middle of each cell to that of the
            nearest occupied one; NaN where the map does not know, infinite where all is free.
        resolution_m: Side of a cell.
        grid_from_asked: From the frame of the points that are asked about to the grid, whose
            cell [0, 0] begins at its origin.
        grid: The map itself.
    """

    distances_m: NDArray[np.float32]
    resolution_m: float
    grid_from_asked: RigidTransform
    grid: OccupancyGrid

    @staticmethod
    def of(grid: OccupancyGrid) -> RoomMap:
        """Work out all distances; points are asked about in the map's own frame."""
        free = (grid.cells < OCCUPIED_FROM).astype(np.uint8)
        distances_m = np.full(free.shape, np.inf, np.float32)
        if not free.all():
            in_cells = cv2.distanceTransform(free, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
            distances_m = np.asarray(in_cells * np.float32(grid.resolution_m))
        distances_m[grid.cells == UNKNOWN] = np.nan
        map_from_grid = RigidTransform.from_planar(*grid.origin)
        return RoomMap(distances_m, grid.resolution_m, map_from_grid.inverse(), grid)

    def seen_from(self, map_from_other: RigidTransform) -> RoomMap:
        """The same map for points of another frame.

        Args:
            map_from_other: Where that frame is in the frame that is asked about now.
        """
        return replace(self, grid_from_asked=self.grid_from_asked @ map_from_other)

    @property
    def located(self) -> LocatedMap:
        """The map in the frame of the points that are asked about, to be drawn."""
        x_m, y_m, yaw_rad = self.grid_from_asked.inverse().planar.tolist()
        return LocatedMap(self.grid, (x_m, y_m, yaw_rad))

    def distance_m(self, xy_m: FloatArray) -> FloatArray:
        """How far points are from the nearest occupied cell.

        Args:
            xy_m: Shape (N, 2); NaN gives NaN.

        Returns:
            Shape (N,), in meters, to half a cell; 0 on an occupied cell, NaN outside the map and
            where it does not know.
        """
        x_m, y_m, yaw_rad = self.grid_from_asked.planar
        cosine, sine = np.cos(yaw_rad), np.sin(yaw_rad)
        across = cosine * xy_m[:, 0] - sine * xy_m[:, 1] + x_m
        up = sine * xy_m[:, 0] + cosine * xy_m[:, 1] + y_m
        rows, columns = self.distances_m.shape
        row, column = np.floor(up / self.resolution_m), np.floor(across / self.resolution_m)
        inside = (row >= 0) & (row < rows) & (column >= 0) & (column < columns)
        row, column = (np.where(inside, index, 0).astype(np.int64) for index in (row, column))
        return np.asarray(np.where(inside, self.distances_m[row, column], np.nan))

    def furniture_log_odds(self, distance_m: FloatArray) -> FloatArray:
        """How much likelier person-sized things so far from occupied cells are no people.

        Furniture of the map lies on its occupied cells, with a Gaussian spread for the errors of
        the map and of the robot's pose; people, and furniture that was moved, are anywhere.

        Args:
            distance_m: Shape (N,), of what a scan shows of them; NaN where the map does not know.

        Returns:
            Shape (N,), natural logarithm: 3 on an occupied cell, 0 about one and a half cells and
            .1 m beside it, a little below 0 far from any; 0 where the map does not know.
        """
        reach_m = _REACH_CELLS * self.resolution_m + _REACH_M
        # The spread with which both kinds are equally likely at the reach.
        spread_m = reach_m / np.sqrt(2.0 * np.log(_NEAR_ODDS / (1.0 - _FAR_ODDS)))
        near = _NEAR_ODDS * np.exp(-0.5 * (distance_m / spread_m) ** 2)
        return np.where(np.isnan(distance_m), 0.0, np.log(near + _FAR_ODDS))
