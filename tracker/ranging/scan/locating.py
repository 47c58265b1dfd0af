"""Where did each beam end? By the laser's roll, pitch, yaw, and its motion during the scan."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray, LocatedScan, Scan
from tracker.geometry import RigidTransform, rotation_matrix

#: A beam that climbs or falls by more than this can meet the floor or the ceiling; that of a
#: level scanner cannot, whatever height its transform claims.
_SLOPE_MIN = float(np.sin(np.radians(3.0)))
#: So near to the floor (z = 0 of the fixed frame) a sloping beam has met the floor (guess) ...
_FLOOR_M = 0.08
#: ... and above this nobody stands.
_OVER_HEADS_M = 2.2


def locate_scan(
    scan: Scan,
    fixed_from_laser: RigidTransform,
    fixed_from_laser_at_end: RigidTransform | None = None,
) -> LocatedScan:
    """See a scan from above, in the fixed frame.

    Args:
        scan: The scan.
        fixed_from_laser: The laser at the scan's stamp, whatever its roll and pitch.
        fixed_from_laser_at_end: The same at `Scan.end_ns`; None where that is not known, and the
            laser is supposed to have stood still.
    """
    angle, beams = scan.angles_rad, len(scan.ranges_m)
    origin_m, attitude = _poses(fixed_from_laser, fixed_from_laser_at_end, beams)
    ahead, left = attitude[:, 0], attitude[:, 1]
    direction = ahead * np.cos(angle) + left * np.sin(angle)
    level = np.hypot(direction[0], direction[1])

    valid = scan.valid
    range_m = np.where(valid, scan.ranges_m, np.nan)
    xy_m = origin_m[:2] + range_m * direction[:2]
    height_m = origin_m[2] + range_m * direction[2]
    is_nobody = (np.abs(height_m) < _FLOOR_M) | (height_m > _OVER_HEADS_M)
    is_nobody &= np.abs(direction[2]) > _SLOPE_MIN
    return LocatedScan(
        stamp_ns=scan.stamp_ns,
        frame_id=scan.frame_id,
        laser_xy_m=origin_m[:2].mean(axis=1),
        xy_m=xy_m.T,
        range_m=np.where(scan.shows_nothing, np.inf, range_m * level),
        heading_rad=np.unwrap(np.arctan2(direction[1], direction[0])),
        spacing_rad=abs(scan.angle_increment_rad),
        range_max_m=scan.range_max_m,
        valid=valid & ~is_nobody,
        is_full_turn=beams > 1 and (beams + 0.5) * abs(scan.angle_increment_rad) >= 2 * np.pi,
    )


def _poses(
    start: RigidTransform, end: RigidTransform | None, beams: int
) -> tuple[FloatArray, FloatArray]:
    """Origin, shape (3, B), and rotation matrix, shape (3, 3, B), of the laser at each beam.

    The last axis has one entry where the laser stands still. Rotations are interpolated linearly
    and normalized, which differs from slerp by less than .1 % of a turn of half a radian.
    """
    if end is None or end == start or beams < 2:
        return np.array([start.translation_m]).T, rotation_matrix(
            np.array([start.quaternion_xyzw]).T
        )
    share = np.linspace(0.0, 1.0, beams)
    p, q = np.array([start.quaternion_xyzw, end.quaternion_xyzw])
    q = q if p @ q >= 0.0 else -q  # of the two ways round, the short one
    turn = (1.0 - share) * p[:, None] + share * q[:, None]
    from_m, to_m = np.array([start.translation_m, end.translation_m])
    origin_m = from_m[:, None] + share * (to_m - from_m)[:, None]
    return origin_m, rotation_matrix(turn / np.linalg.norm(turn, axis=0))
