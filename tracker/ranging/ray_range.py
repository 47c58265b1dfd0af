"""What is the range along the hand's ray? The specification's median, with parallax."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray, LocatedScan
from tracker.geometry import normalize_angle
from tracker.ranging.rays import HandRays
from tracker.ranging.scan.beams import median_range


def range_along_rays(
    rays: HandRays, scan: LocatedScan, window_beams: int, jump_m: float
) -> FloatArray:
    """Algorithm 5 at each ray, for a laser that is not at the camera's place.

    Where laser and camera coincide this is the median at the hand's bearing itself. Elsewhere the
    beam that counts is the one whose point lies on the camera's ray; of several the nearest.

    Args:
        rays: Hands' directions, from the camera.
        scan: The scan, in the fixed frame.
        window_beams: Beams to each side whose median counts.
        jump_m: Neighboring points farther apart than this are no surface.

    Returns:
        Shape (H,): meters from the camera; NaN where the scan gives nothing.
    """
    heading = rays.bearing_rad + rays.origin[2]
    baseline = rays.origin[:2] - scan.laser_xy_m
    if not np.any(baseline):
        return median_range(scan, heading, window_beams)
    direction = np.stack([np.cos(heading), np.sin(heading)], axis=-1)
    crossing = _heading_of_crossing(scan, rays.origin[:2], heading, jump_m)
    range_m = median_range(scan, crossing, window_beams)
    # The point of the ray at that range from the laser: |baseline + s direction| = range.
    along = direction @ baseline
    reach = along**2 + range_m**2 - baseline @ baseline
    result = -along + np.sqrt(np.where(reach >= 0.0, reach, np.nan))
    return np.where(result > 0.0, result, np.nan)


def _heading_of_crossing(
    scan: LocatedScan, origin_m: FloatArray, heading: FloatArray, jump_m: float
) -> FloatArray:
    """Laser's heading to the nearest surface point on each ray, shape (H,); NaN for none."""
    beams = np.flatnonzero(scan.valid)
    result = np.full(len(heading), np.nan)
    if len(beams) < 2:
        return result
    points = scan.xy_m[beams] - origin_m
    after = np.roll(points, -1, axis=0)
    is_surface = np.linalg.norm(after - points, axis=-1) <= jump_m
    bearing = np.arctan2(points[:, 1], points[:, 0])
    off = normalize_angle(bearing - heading[:, None])
    off_after = np.roll(off, -1, axis=1)
    crosses = (off * off_after <= 0.0) & (np.abs(off) + np.abs(off_after) < np.pi / 2)
    # A surface that is crossed comes before an edge that the ray passes between two surfaces.
    distance = np.linalg.norm(points, axis=-1) + np.where(is_surface, 0.0, 1e6)
    distance = np.where(crosses, distance, np.inf)
    nearest = np.argmin(distance, axis=1)
    found = crosses.any(axis=1)
    result[found] = scan.heading_rad[beams[nearest[found]]]
    return result
