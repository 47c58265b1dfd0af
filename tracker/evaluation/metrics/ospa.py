"""How far are tracks and people apart on average? OSPA, the older of the set distances."""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment

from tracker.containers import FloatArray


def ospa(
    tracks_xy_m: FloatArray, people_xy_m: FloatArray, cutoff_m: float = 1.0, order: float = 2.0
) -> float:
    """Optimal sub-pattern assignment distance of two sets of points, in meters.

    Args:
        tracks_xy_m: Shape (N, 2).
        people_xy_m: Shape (P, 2), in the same frame.
        cutoff_m: c: the price of a far pair, of a missed person and of a false track.
        order: p.

    Source: Schuhmacher, Vo, Vo, "A consistent metric for performance evaluation of multi-object
        filters", IEEE Transactions on Signal Processing 56(8), 2008.
    """
    larger = max(len(tracks_xy_m), len(people_xy_m))
    if larger == 0:
        return 0.0
    distance = np.linalg.norm(tracks_xy_m[:, None] - people_xy_m[None], axis=-1)
    cost = np.minimum(distance, cutoff_m) ** order
    rows, columns = linear_sum_assignment(cost)
    alone = cutoff_m**order * (larger - len(rows))
    return float(((cost[rows, columns].sum() + alone) / larger) ** (1.0 / order))
