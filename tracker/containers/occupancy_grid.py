"""Which cells of the floor are occupied? The map of nav_msgs/OccupancyGrid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from tracker.containers.arrays import check_stamp, frozen
from tracker.errors import ShapeError

CellArray: TypeAlias = NDArray[np.int8]

#: A cell that nobody has looked at.
UNKNOWN = -1
#: From so many percent on a cell counts as occupied; what map_server asks for by default.
OCCUPIED_FROM = 65


@dataclass(frozen=True, slots=True, eq=False)
class OccupancyGrid:
    """A map of the floor in square cells.

    Attributes:
        stamp_ns: When it was made or sent.
        frame_id: The frame it lies in, as `map`.
        resolution_m: Side of a cell.
        origin: x_m, y_m, yaw_rad of the outer corner of cell [0, 0] in that frame.
        cells: Shape (rows, columns), int8: how likely something stands there, 0 to 100 percent;
            `UNKNOWN` where nobody has looked. Columns run along the grid's x axis, rows along y.

    Raises:
        ShapeError: The map has no cells, cells of no size, or numbers that say nothing.
        ClockError: The stamp is negative.
    """

    stamp_ns: int
    frame_id: str
    resolution_m: float
    origin: tuple[float, float, float]
    cells: CellArray

    def __post_init__(self) -> None:
        check_stamp(self.stamp_ns)
        object.__setattr__(self, "cells", frozen(self.cells, np.dtype(np.int8)))
        if self.cells.ndim != 2 or 0 in self.cells.shape:
            raise ShapeError(
                f"A map has cells of shape {self.cells.shape}; expected rows and columns."
            )
        if not (np.isfinite(self.resolution_m) and self.resolution_m > 0.0):
            raise ShapeError(
                f"A map has a resolution of {self.resolution_m} m; expected the side of a cell, "
                "above 0."
            )
        if len(self.origin) != 3 or not np.all(np.isfinite(self.origin)):
            raise ShapeError(
                f"A map has the origin {self.origin}; expected x, y and yaw, all finite."
            )
        low, high = int(self.cells.min()), int(self.cells.max())
        if low < UNKNOWN or high > 100:
            raise ShapeError(
                f"A map holds the numbers {low} to {high}; expected 0 to 100, and {UNKNOWN} "
                "for unknown."
            )


@dataclass(frozen=True, slots=True, eq=False)
class LocatedMap:
    """A map, and where it lies in the fixed frame.

    Attributes:
        grid: The map; its own origin is in its own frame.
        origin: x_m, y_m, yaw_rad of the outer corner of cell [0, 0] in the fixed frame.
    """

    grid: OccupancyGrid
    origin: tuple[float, float, float]
