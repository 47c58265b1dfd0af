"""A small world of legs and walls, ray-cast by hand, that the ranging tests share."""

import numpy as np
import pytest

from tracker import Scan
from tracker.geometry import RigidTransform
from tracker.ranging import locate_scan


@pytest.fixture
def cast():
    """Return a function that scans circles (x, y, radius) in a round room from a laser pose.

    Some beams may be `lost`; the scan comes located.
    """

    def cast_scan(circles, laser_pose=(0.0, 0.0, 0.0), wall_m=6.0, beams=720, stamp_ns=0, lost=()):
        increment = 2 * np.pi / beams
        angles = np.arange(beams) * increment + laser_pose[2]
        ranges = np.full(beams, wall_m)
        for x, y, radius in circles:
            dx, dy = x - laser_pose[0], y - laser_pose[1]
            along = dx * np.cos(angles) + dy * np.sin(angles)
            across = -dx * np.sin(angles) + dy * np.cos(angles)
            hit = (np.abs(across) < radius) & (along > 0)
            depth = along - np.sqrt(np.maximum(radius**2 - across**2, 0.0))
            ranges = np.where(hit, np.minimum(ranges, depth), ranges)
        ranges[list(lost)] = np.inf
        scan = Scan(stamp_ns, "laser", 0.0, increment, 0.05, 12.0, ranges)
        return locate_scan(scan, RigidTransform.from_planar(*laser_pose))

    return cast_scan


@pytest.fixture
def legs():
    """Return a function that gives the two legs of somebody at (x, y)."""

    def two_legs(x, y, apart=0.2):
        return [(x, y - apart / 2, 0.07), (x, y + apart / 2, 0.07)]

    return two_legs
