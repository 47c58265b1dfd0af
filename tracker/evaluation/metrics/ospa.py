"""How far are tracks and people apart on average? OSPA, the older of the set distances."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray, IntArray
from tracker.evaluation.metrics.gospa import Gospa, GospaFrames, gospa


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
    return float(ospa_of(gospa(tracks_xy_m, people_xy_m, cutoff_m, order), larger, order))


def ospa_of(parts: Gospa | GospaFrames, larger: IntArray | int, order: float = 2.0) -> FloatArray:
    """OSPA from GOSPA's parts, which rest on the same pairs.

    Whoever is left alone in the larger set costs c^p, and GOSPA counted half of that:
    ospa^p = (localisation + 2 max(missed, false)) / larger.

    Args:
        parts: GOSPA with the same cutoff and order.
        larger: Shape (T,), or one number: how many the larger set has.
        order: p.
    """
    total = parts.localisation + 2.0 * np.maximum(parts.missed, parts.false)
    return np.asarray((total / np.maximum(larger, 1)) ** (1.0 / order))
