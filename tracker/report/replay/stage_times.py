"""How long did each stage of an image take?"""

from __future__ import annotations

import numpy as np

from tracker.containers import FrameResult
from tracker.report.page import Table

_NAMES = (
    "perception: palm search",
    "perception: landmarks of new hands",
    "perception, all of it",
    "ranging and tracking",
    "the whole image",
)
_BIN_EDGES_S = np.geomspace(1e-6, 1e2, 2001)  # steps of 1 %


class StageTimes:
    """Counts times in bins of 1 %, so that memory does not grow with the recording."""

    def __init__(self) -> None:
        self._counts = np.zeros((len(_NAMES), len(_BIN_EDGES_S)), dtype=np.int64)
        self._longest_s = np.zeros(len(_NAMES))

    def write(self, result: FrameResult, busy_s: float) -> None:
        """Take in an image.

        Args:
            result: With perception's own times, where the detector tells them.
            busy_s: On the wall, that the pipeline took for it.
        """
        work = result.work
        times_s = np.full(len(_NAMES), np.nan)
        times_s[4] = busy_s
        if work is not None:
            rest_s = max(0.0, busy_s - work.total_s)
            times_s[:4] = work.search_s, work.new_hands_s, work.total_s, rest_s
        for stage in np.flatnonzero(np.isfinite(times_s)):
            place = np.searchsorted(_BIN_EDGES_S, times_s[stage]).clip(max=len(_BIN_EDGES_S) - 1)
            self._counts[stage, place] += 1
            self._longest_s[stage] = max(self._longest_s[stage], times_s[stage])

    def median_s(self) -> float:
        """Of the whole image; NaN where nothing was measured."""
        return self._quantile_s(-1, 0.5)

    def table(self) -> Table:
        """Median, 99 % and the longest of each stage, in milliseconds."""
        rows = tuple(
            (
                name,
                f"{1e3 * self._quantile_s(stage, 0.5):.1f}",
                f"{1e3 * self._quantile_s(stage, 0.99):.1f}",
                f"{1e3 * self._longest_s[stage]:.1f}",
            )
            for stage, name in enumerate(_NAMES)
            if self._counts[stage].any()
        )
        columns = ("stage", "median (ms)", "99 % (ms)", "longest (ms)")
        return Table(columns, rows, numeric=frozenset({1, 2, 3}))

    def _quantile_s(self, stage: int, share: float) -> float:
        summed = np.cumsum(self._counts[stage])
        if summed[-1] == 0:
            return float("nan")
        edge_s = _BIN_EDGES_S[np.searchsorted(summed, share * summed[-1])]
        return float(min(edge_s, self._longest_s[stage]))
