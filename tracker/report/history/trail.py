"""A path of any length in little memory: it is halved whenever it grows too long."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray


class Trail:
    """Rows of numbers, evenly thinned so that they never exceed a capacity.

    The first row is always kept, and `last` is the newest one even where thinning passes over it.

    Args:
        columns: Numbers per row.
        capacity: Rows kept at most.
    """

    def __init__(self, columns: int, capacity: int = 512) -> None:
        self._rows: list[tuple[float, ...]] = []
        self._columns = columns
        self._capacity = capacity
        self._stride = 1
        self._count = 0
        self.last: tuple[float, ...] | None = None

    def __len__(self) -> int:
        return len(self._rows)

    def append(self, *row: float) -> None:
        """Take in the next row."""
        self.last = row
        if self._count % self._stride == 0:
            self._rows.append(row)
        self._count += 1
        if len(self._rows) > self._capacity:
            del self._rows[1::2]
            self._stride *= 2

    @property
    def rows(self) -> FloatArray:
        """Shape (R, columns): what was kept, and the newest row at the end."""
        rows = list(self._rows)
        if self.last is not None and rows[-1] is not self.last:
            rows.append(self.last)
        return np.array(rows, dtype=np.float64).reshape(-1, self._columns)
