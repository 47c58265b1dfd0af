"""Where did scans hit something? A map-like background for plots, of fixed size in memory."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray, LocatedScan

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

    def add(self, scan: LocatedScan) -> None:
        """Count one scan."""
        points = scan.returns_m(_REACH_M)
        if len(points) == 0:
            return
        if self._center is None:
            self._center = scan.laser_xy_m
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
