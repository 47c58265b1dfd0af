"""What does a depth image show from above, at the height of bodies? Like a laser scan.

For each direction the nearest thing that is tall enough to be no stray reading, between the table
tops and the top of people's heads. What reads a scan, reads this.
"""

from __future__ import annotations

import numpy as np

from tracker.containers import LocatedScan
from tracker.ranging.depth.points import DepthPoints

#: Above this there are lamps and ceilings, and few heads.
_OVER_HEADS_M = 2.0
#: Where the floor is not known: from so far below the camera to so far above it (guess).
_BELOW_CAMERA_M, _ABOVE_CAMERA_M = 0.35, 0.8
#: Ranges in a bin differ by this factor at most: a body is about as deep, and noise grows with
#: the range (guess).
_BIN_RATIO = 1.05
_NEAREST_M, _FARTHEST_M = 0.2, 20.0
_BINS = int(np.ceil(np.log(_FARTHEST_M / _NEAREST_M) / np.log(_BIN_RATIO)))
#: In two bins side by side a thing shows readings of so much height in all, and so many (guess).
#: Pixels that mix two surfaces, and those that the sun disturbs, lie scattered over many bins.
_TALL_M, _READINGS_MIN = 0.12, 3


def depth_slice(points: DepthPoints, height_min_m: float) -> LocatedScan:
    """The nearest thing in each direction, at the height of bodies.

    Args:
        points: What the depth image shows.
        height_min_m: Above the floor; what is lower is left out.

    Returns:
        One beam for each column of the grid, or so, from the right to the left. NaN where nothing
        is seen: that may be a hole, and says nothing.
    """
    low_m, high_m = points.floor_z_m + height_min_m, points.floor_z_m + _OVER_HEADS_M
    if np.isnan(points.floor_z_m):
        low_m, high_m = points.camera_z_m - _BELOW_CAMERA_M, points.camera_z_m + _ABOVE_CAMERA_M
    spacing = points.spacing_rad
    right, left = float(np.nanmin(points.heading_rad)), float(np.nanmax(points.heading_rad))
    beams = int((left - right) / spacing) + 1
    height_m = points.xyz_m[2]
    with np.errstate(invalid="ignore"):
        kept = (height_m > low_m) & (height_m < high_m)
        kept &= (points.range_m > _NEAREST_M) & (points.range_m < _FARTHEST_M)
    rows = np.flatnonzero(kept)
    range_m = points.range_m[rows].astype(np.float64)
    beam = np.minimum(((points.heading_rad[rows] - right) / spacing).astype(np.int64), beams - 1)
    level = (np.log(range_m / _NEAREST_M) / np.log(_BIN_RATIO)).astype(np.int64)
    cell = beam * (_BINS + 1) + np.minimum(level, _BINS - 1)
    size = beams * (_BINS + 1)
    count = np.bincount(cell, minlength=size).reshape(beams, -1)
    total_m = np.bincount(cell, weights=range_m, minlength=size).reshape(beams, -1)
    count[:, :-1] += count[:, 1:]
    total_m[:, :-1] += total_m[:, 1:]
    # A reading of the grid stands for so much height: its spacing, by the range of the bin.
    bin_m = _NEAREST_M * _BIN_RATIO ** np.arange(_BINS + 1)
    is_thing = count >= np.maximum(_TALL_M / (spacing * bin_m), _READINGS_MIN)
    first = is_thing.argmax(axis=1)
    every = np.arange(beams)
    is_seen = is_thing[every, first]
    nearest_m = np.where(
        is_seen, total_m[every, first] / np.maximum(count[every, first], 1), np.nan
    )
    x_m, y_m, yaw_rad = points.pose
    heading = yaw_rad + right + (every + 0.5) * spacing
    origin = np.array([x_m, y_m])
    direction = np.stack([np.cos(heading), np.sin(heading)], axis=-1)
    return LocatedScan(
        stamp_ns=points.stamp_ns,
        frame_id=points.frame_id,
        laser_xy_m=origin,
        xy_m=origin + nearest_m[:, None] * direction,
        range_m=nearest_m,
        heading_rad=heading,
        spacing_rad=spacing,
        range_max_m=_FARTHEST_M,
        valid=is_seen,
        is_full_turn=False,
    )
