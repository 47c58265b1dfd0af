"""Which claims are of a body that the depth image shows as well?"""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, Measurements
from tracker.ranging.depth.noise import depth_noise_m

#: What two sensors show of one body is no farther apart: legs stand beside the torso, or before it
#: where somebody sits (guess).
_SAME_BODY_M = 0.45
#: Noise that much larger than the scan's is soon averaged away (guess).
_AVERAGED = 2.0


def are_near(xy_m: FloatArray, others_xy_m: FloatArray) -> BoolArray:
    """Which places, shape (C, 2), are near one of the others, shape (K, 2); shape (C,)."""
    apart_m = np.linalg.norm(xy_m[:, None] - others_xy_m, axis=-1)
    return np.asarray((apart_m < _SAME_BODY_M).any(axis=1))


def without_seen(claims: Measurements, bodies_xy_m: FloatArray, config: Config) -> Measurements:
    """Leave out the scan's measurement of a body that the depth image measures more exactly.

    The scan shows legs. How these stand to the torso stays the same for as long as somebody sits,
    and does not average out, while the noise of depth does; so up to some range the torso counts
    alone.

    Args:
        claims: Of hands and of the scan, all with bearing and range from the color camera.
        bodies_xy_m: Shape (K, 2): bodies in the depth image.
        config: `depth_std_m` and `range_std_m`.
    """
    bearing_rad, range_m = claims.values.T
    heading = claims.sensor_pose[:, 2] + bearing_rad
    direction = np.stack([np.cos(heading), np.sin(heading)], axis=-1)
    xy_m = claims.sensor_pose[:, :2] + range_m[:, None] * direction
    of_scan = claims.hand < 0
    is_exact = depth_noise_m(range_m, config) < _AVERAGED * config.range_std_m
    return claims[~(of_scan & is_exact & are_near(xy_m, bodies_xy_m))]
