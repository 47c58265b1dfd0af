"""Which errors of a position last? Legs beside the torso, hand beside the body, yaw, stamps.

Sensors that move with velocity v and turn rate w, and whose stamps are late by t, measure a place
at the offset d from them with an error of t u, with

    u = v + w (-d_y, d_x).

The motion of people in that time is neglected: at 1 m/s and 20 ms it is 2 cm.
"""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import FloatArray


def bias_covariance(
    heading_rad: FloatArray,
    range_m: FloatArray,
    config: Config,
    *,
    along_m: FloatArray | float,
    across_m: FloatArray | float,
    motion: FloatArray,
) -> FloatArray:
    """Covariance of the error that all measurements of a person share, in the fixed frame.

    Args:
        heading_rad: Shape (M,): of the lines of sight, in the fixed frame.
        range_m: Shape (M,).
        config: `mounting_std_deg` and `stamp_std_s`.
        along_m: Standard deviation along the line of sight, of the person's own build or pose.
        across_m: The same across it.
        motion: Shape (3,): x_mps, y_mps, yaw_radps of the sensors in the fixed frame.

    Returns:
        Shape (M, 2, 2), in square meters.
    """
    turned_m = np.deg2rad(config.mounting_std_deg) * range_m
    sight = np.stack([np.cos(heading_rad), np.sin(heading_rad)], axis=-1)
    left = np.stack([-sight[:, 1], sight[:, 0]], axis=-1)
    shift = motion[:2] + motion[2] * range_m[:, None] * left
    parts = (
        (along_m, sight),
        (across_m, left),
        (turned_m, left),
        (config.stamp_std_s, shift),
    )
    return np.asarray(
        sum(
            np.reshape(std_m, (-1, 1, 1)) ** 2 * each[:, :, None] * each[:, None]
            for std_m, each in parts
        )
    )
