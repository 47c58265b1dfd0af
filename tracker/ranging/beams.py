"""How far is it along an angle? Equation 11 and algorithm 5 of the specification."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tracker.containers import FloatArray, IntArray, Scan
from tracker.geometry import normalize_angle

#: Keeps an angle that stands exactly on a beam from falling to the beam before by rounding.
_BEAM_ROUNDING = 1e-6


def beam_index(scan: Scan, angle_rad: ArrayLike) -> IntArray:
    """Beam that looks along an angle (equation 11), for scanners of any start, sense and span.

    The equation's quotient is taken on the turn in which the angle is nearest to the middle of the
    scan, so that a scanner of 0..2 pi answers for negative angles too.

    Args:
        scan: The scan.
        angle_rad: Shape (K,), in the laser's frame.

    Returns:
        Shape (K,). Angles beside the scan give indices below 0 or beyond the last beam.
    """
    middle = (len(scan.ranges_m) - 1) / 2
    middle_rad = scan.angle_min_rad + scan.angle_increment_rad * middle
    turn = normalize_angle(np.asarray(angle_rad) - middle_rad)
    quotient = turn / scan.angle_increment_rad + middle
    index = np.floor(quotient + _BEAM_ROUNDING).astype(np.int64)
    return index % len(scan.ranges_m) if is_full_turn(scan) else index


def is_full_turn(scan: Scan) -> bool:
    """Whether the beam after the last one is the first one again."""
    beams = len(scan.ranges_m)
    return beams > 1 and (beams + 0.5) * abs(scan.angle_increment_rad) >= 2 * np.pi


def median_range(scan: Scan, angle_rad: ArrayLike, window_beams: int = 3) -> FloatArray:
    """Median of the valid ranges around an angle (algorithm 5), wrapping where the scan does.

    Args:
        scan: The scan; infinite, NaN and out-of-range beams do not count.
        angle_rad: Shape (K,), in the laser's frame; NaN gives NaN.
        window_beams: Beams to each side of the one that equation 11 names.

    Returns:
        Shape (K,), in meters; NaN where no beam of the window has a return.
    """
    angle = np.atleast_1d(np.asarray(angle_rad, dtype=np.float64))
    beams = len(scan.ranges_m)
    if beams == 0 or len(angle) == 0:
        return np.full(len(angle), np.nan)
    known = np.isfinite(angle)
    middle = beam_index(scan, np.where(known, angle, 0.0))
    window = middle[:, None] + np.arange(-window_beams, window_beams + 1)
    inside = known[:, None] & np.ones(window.shape, dtype=bool)
    if is_full_turn(scan):
        window %= beams
    else:
        inside &= (window >= 0) & (window < beams)
        window = np.clip(window, 0, beams - 1)
    counts = inside & scan.valid[window]
    ranges = np.where(counts, scan.ranges_m[window], np.nan)
    result = np.full(len(angle), np.nan)
    seen = counts.any(axis=1)
    result[seen] = np.nanmedian(ranges[seen], axis=1)
    return result
