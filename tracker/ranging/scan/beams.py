"""How far is it along an angle? Equation 11 and algorithm 5 of the specification."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tracker.containers import FloatArray, IntArray, LocatedScan
from tracker.geometry import normalize_angle

#: Keeps an angle that stands exactly on a beam from falling to the beam before by rounding.
_BEAM_ROUNDING = 1e-6


def beam_index(scan: LocatedScan, heading_rad: ArrayLike) -> IntArray:
    """Beam that looks along a heading (equation 11), for scanners of any start, sense and span.

    Equation 11 rounds down: the beam asked for is the last one that comes no later than the
    heading. It is sought on the turn in which the heading is nearest to the middle of the scan, so
    that a scanner of 0..2 pi answers for negative angles too.

    Args:
        scan: The scan.
        heading_rad: Shape (K,), in the fixed frame.

    Returns:
        Shape (K,). Headings beside the scan give indices below 0 or beyond the last beam.
    """
    sense = -1.0 if scan.heading_rad[-1] < scan.heading_rad[0] else 1.0
    beams = sense * scan.heading_rad  # ascending
    middle = (beams[0] + beams[-1]) / 2
    turn = middle + normalize_angle(sense * np.asarray(heading_rad) - middle)
    turn = turn + _BEAM_ROUNDING * scan.spacing_rad
    before, after = ((turn - beams[[0, -1]][:, None]) // scan.spacing_rad).astype(np.int64)
    index = np.searchsorted(beams, turn, side="right") - 1
    index = np.where(before < 0, before, index + np.maximum(after, 0))
    return np.asarray(index % len(scan) if scan.is_full_turn else index, dtype=np.int64)


def median_range(scan: LocatedScan, heading_rad: ArrayLike, window_beams: int = 3) -> FloatArray:
    """Median of the valid ranges around a heading (algorithm 5), wrapping where the scan does.

    Args:
        scan: The scan; infinite, NaN and out-of-range beams do not count.
        heading_rad: Shape (K,), in the fixed frame; NaN gives NaN.
        window_beams: Beams to each side of the one that equation 11 names.

    Returns:
        Shape (K,), in meters; NaN where no beam of the window has a return.
    """
    heading = np.atleast_1d(np.asarray(heading_rad, dtype=np.float64))
    beams = len(scan)
    if beams == 0 or len(heading) == 0:
        return np.full(len(heading), np.nan)
    known = np.isfinite(heading)
    middle = beam_index(scan, np.where(known, heading, 0.0))
    window = middle[:, None] + np.arange(-window_beams, window_beams + 1)
    inside = known[:, None] & np.ones(window.shape, dtype=bool)
    if scan.is_full_turn:
        window %= beams
    else:
        inside &= (window >= 0) & (window < beams)
        window = np.clip(window, 0, beams - 1)
    counts = inside & scan.valid[window]
    ranges = np.where(counts, scan.range_m[window], np.nan)
    result = np.full(len(heading), np.nan)
    seen = counts.any(axis=1)
    result[seen] = np.nanmedian(ranges[seen], axis=1)
    return result
