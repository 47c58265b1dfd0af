"""What are bearings with ranges as points of the fixed frame?"""

from __future__ import annotations

import numpy as np

from tracker.containers.measurements import Measurements


def as_positions(measurements: Measurements) -> Measurements:
    """Bearings with ranges as points of the fixed frame; either alone is left out.

    The noise is turned to first order, which is what makes far customers with coarse bearings
    worse here than in the product.

    Args:
        measurements: Bearings and ranges.
    """
    ranged = measurements[np.isfinite(measurements.values).all(axis=1)]
    pose, range_m = ranged.sensor_pose, ranged.values[:, 1]
    angle = pose[:, 2] + ranged.values[:, 0]
    cos, sin = np.cos(angle), np.sin(angle)
    turn = np.moveaxis(np.array([[-range_m * sin, cos], [range_m * cos, sin]]), -1, 0)
    return Measurements.cartesian(
        pose[:, :2] + range_m[:, None] * np.stack([cos, sin], axis=-1),
        turn @ ranged.covariance @ np.swapaxes(turn, 1, 2),
        raised=ranged.raised,
    )
