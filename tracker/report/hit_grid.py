"""Where have scans met something? A map-like backdrop for pictures, of fixed size in memory."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray, Scan
from tracker.geometry import polar_to_cartesian

_SIDE = 1024  # cells; 31 m at first, and twice that after each coarsening
_REACH_M = 12.0  # farther beams spread too wide to draw a wall


class HitGrid:
    """Counts scans per cell; doubles its cells when a hit falls outside.

    Args:
        cell_m: Side of a cell at first.
    """

    def __init__(self, cell_m: float = 0.03) -> None:
        self.cell_m = cell_m
        self._center: FloatArray | None = None
        self._counts = np.zeros((_SIDE, _SIDE), dtype=np.uint32)

    def add(self, scan: Scan, pose: FloatArray) -> None:
        """Count one scan.

        Args:
            scan: The scan.
            pose: Shape (3,): x_m, y_m, yaw_rad of its laser in the fixed frame.
        """
        points = scan_points(scan, pose, _REACH_M)
        if len(points) == 0:
            return
        if self._center is None:
            self._center = np.array(pose[:2], dtype=np.float64)
        offset = points - self._center
        while np.max(np.abs(offset)) >= self.cell_m * _SIDE / 2:
            self._coarsen()
        cells = np.floor(offset / self.cell_m).astype(np.int64) + _SIDE // 2
        seen = np.unique(cells[:, 0] * _SIDE + cells[:, 1])  # once per scan, however many beams
        self._counts.reshape(-1)[seen] += 1

    @property
    def hits(self) -> tuple[FloatArray, FloatArray]:
        """Centers of the cells that were hit, shape (C, 2), in meters, and how often each was."""
        cells = np.argwhere(self._counts)
        counts = self._counts[cells[:, 0], cells[:, 1]].astype(np.float64)
        center = self._center if self._center is not None else np.zeros(2)
        return (cells - _SIDE // 2 + 0.5) * self.cell_m + center, counts

    def _coarsen(self) -> None:
        blocks = self._counts.reshape(_SIDE // 2, 2, _SIDE // 2, 2).max(axis=(1, 3))
        quarter = _SIDE // 4
        self._counts = np.zeros_like(self._counts)
        self._counts[quarter:-quarter, quarter:-quarter] = blocks
        self.cell_m *= 2


def scan_points(scan: Scan, pose: FloatArray, reach_m: float = np.inf) -> FloatArray:
    """Returns of a scan in the fixed frame, shape (B', 2), no farther than `reach_m`.

    Args:
        scan: The scan.
        pose: Shape (3,): x_m, y_m, yaw_rad of its laser in the fixed frame.
        reach_m: Returns beyond are left out.
    """
    good = scan.valid & (scan.ranges_m <= reach_m)
    return polar_to_cartesian(scan.ranges_m[good], scan.angles_rad[good] + pose[2]) + pose[:2]
