"""Which track stands for which person? Frame after frame, and faithful while both stay near."""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment

from tracker.containers import FloatArray, IntArray


class Matcher:
    """Pairs tracks with people as the CLEAR MOT metrics do.

    A pair of the last frame stays one while it is nearer than the cutoff, even where another
    would be nearer; the rest are paired at the least sum of squared distances.

    Args:
        cutoff_m: No pair is farther apart.

    Source: Bernardin, Stiefelhagen, "Evaluating multiple object tracking performance: the CLEAR
        MOT metrics", EURASIP Journal on Image and Video Processing, 2008.
    """

    def __init__(self, cutoff_m: float = 1.0) -> None:
        self._cutoff_m = cutoff_m
        self._last: dict[int, int] = {}

    def match(
        self,
        track_id: IntArray,
        tracks_xy_m: FloatArray,
        person_id: IntArray,
        people_xy_m: FloatArray,
    ) -> tuple[IntArray, IntArray]:
        """Pair one frame.

        Args:
            track_id: Shape (N,).
            tracks_xy_m: Shape (N, 2).
            person_id: Shape (P,).
            people_xy_m: Shape (P, 2).

        Returns:
            Rows of the paired tracks and rows of their people, both of shape (K,).
        """
        distance = np.linalg.norm(tracks_xy_m[:, None] - people_xy_m[None], axis=-1)
        near = distance < self._cutoff_m
        row_of = {identity: row for row, identity in enumerate(track_id.tolist())}
        for column, person in enumerate(person_id.tolist()):
            row = row_of.get(self._last.get(person, -1))
            if row is not None and near[row, column]:
                near[row, :] = False
                near[:, column] = False
                near[row, column] = True
        # A pair that must not be costs as much as leaving both alone.
        cost = np.where(near, distance, self._cutoff_m) ** 2
        rows, columns = linear_sum_assignment(cost)
        paired = near[rows, columns]
        rows, columns = rows[paired], columns[paired]
        self._last = dict(zip(person_id[columns].tolist(), track_id[rows].tolist(), strict=True))
        return rows, columns
