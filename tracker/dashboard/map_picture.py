"""The map of the room as a picture, which a browser fetches once for each map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np

from tracker.containers import BoolArray, ImageArray, LocatedMap, OccupancyGrid
from tracker.containers.occupancy_grid import OCCUPIED_FROM

#: Larger maps are shown with larger cells.
_SIDE_PX = 2000
#: In the middle between the dark page and the light one, BGR.
_SHADE = (140, 130, 122)


@dataclass(frozen=True, slots=True)
class MapPicture:
    """One map.

    Attributes:
        number: Counts the maps of a page; a browser fetches a new number.
        grid: The map.
    """

    number: int
    grid: OccupancyGrid

    def after(self, newer: LocatedMap) -> MapPicture:
        """This one, or the next one where the map is another."""
        is_same = newer.grid is self.grid
        return self if is_same else MapPicture(self.number + 1, newer.grid)

    def place(self, located: LocatedMap) -> dict[str, Any]:
        """Where the picture lies in the fixed frame, in JSON's kinds of values."""
        return {
            "number": self.number,
            "origin": [round(value, 4) for value in located.origin],
            "pixel_m": self.grid.resolution_m * _cells_per_pixel(self.grid),
        }

    def png(self) -> bytes:
        """Occupied cells in gray, all else transparent; the first row is the one at the origin."""
        step = _cells_per_pixel(self.grid)
        occupied = _enlarge_cells(self.grid.cells >= OCCUPIED_FROM, step)
        picture: ImageArray = np.zeros((*occupied.shape, 4), np.uint8)
        picture[occupied] = (*_SHADE, 255)
        _, data = cv2.imencode(".png", picture)
        return data.tobytes()


def _cells_per_pixel(grid: OccupancyGrid) -> int:
    side = int(max(grid.cells.shape))
    return max(1, -(-side // _SIDE_PX))


def _enlarge_cells(occupied: BoolArray, step: int) -> BoolArray:
    """Cells of `step` by `step`, occupied where one of them is."""
    rows, columns = occupied.shape
    padded = np.pad(occupied, ((0, -rows % step), (0, -columns % step)))
    blocks = padded.reshape(padded.shape[0] // step, step, padded.shape[1] // step, step)
    return np.asarray(blocks.any(axis=(1, 3)))
