"""Who stands in a depth image? Body-sized pieces of its slice, and what they claim."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, LocatedScan, Measurements
from tracker.geometry import normalize_angle
from tracker.ranging.depth.noise import depth_noise_m
from tracker.ranging.depth.points import DepthPoints
from tracker.ranging.depth.slices import depth_slice
from tracker.ranging.scan.people import PersonClusters
from tracker.ranging.scan.segments import find_segments

#: Neighbors of the slice that are farther apart belong to different things; more than the scan's,
#: since a depth camera's noise is (guess).
_JUMP_M = 0.25
#: From shoulder to shoulder people are .3 m wide and more; half of that is seen beside others.
_WIDTH_MIN_M = 0.15
#: The middle of a body lies about so far behind its skin as the slice shows it (guess).
_INWARD_M = 0.09
_RANGE_MIN_M = 0.05
#: Numbers of bodies (`Measurements.person`) start here, beyond those of the scan's and of hands.
_BODY_OFFSET = 2_000_000
#: People seen at another instant than the image's may have walked on (guess).
_SPEED_STD_MPS = 0.7


@dataclass(frozen=True, slots=True, eq=False)
class DepthBodies:
    """Body-sized things of one depth image.

    Attributes:
        pose: Shape (3,): x_m, y_m, yaw_rad of the depth camera in the fixed frame.
        slice: What it shows from above.
        people: The things, in the fixed frame.
    """

    pose: FloatArray
    slice: LocatedScan
    people: PersonClusters


def find_bodies(points: DepthPoints, config: Config) -> DepthBodies:
    """Find what could be a person at the height of bodies.

    Args:
        points: What the depth image shows.
        config: The ranging group.
    """
    cut = depth_slice(points, config.depth_height_min_m)
    if not cut.valid.any():
        return DepthBodies(points.pose, cut, PersonClusters.none())
    found = find_segments(cut, _JUMP_M)
    width = found.width_m + found.spacing_m
    is_body = (width >= _WIDTH_MIN_M) & (found.width_m <= config.body_width_m) & ~found.is_in_gap
    is_body &= (found.range_m <= config.person_range_max_m) & (found.beams >= 2)
    heading = cut.heading_rad[found.rows]
    inward = _INWARD_M * np.stack([np.cos(heading), np.sin(heading)], axis=-1)
    total = np.add.reduceat(cut.xy_m[found.rows] + inward, found.begins)
    middle = total[is_body] / found.beams[is_body, None]
    # Nobody's slim legs: a body counts for two of them.
    legs = np.full(len(middle), 2, dtype=np.int64)
    people = PersonClusters(middle, found.width_m[is_body], legs, np.zeros(len(middle)))
    return DepthBodies(points.pose, cut, people)


def body_measurements(
    bodies: DepthBodies, is_free: BoolArray, off_s: float, config: Config
) -> Measurements:
    """Measurements of bodies that own no raised hand, seen from the depth camera.

    Args:
        bodies: Of one depth image.
        is_free: Shape (C,): which of them count.
        off_s: From the depth image's stamp to that of the image they are used for.
        config: The ranging group.
    """
    rows = np.flatnonzero(is_free)
    offset = bodies.people.xy_m[rows] - bodies.pose[:2]
    range_m = np.maximum(np.hypot(offset[:, 0], offset[:, 1]), _RANGE_MIN_M)
    # One sensor's claims are known by the pose that they are measured from, and nobody has two of
    # one. The scan's are given from the color camera, which may be this very camera; so here
    # bearings count from straight behind it.
    origin = bodies.pose + np.array([0.0, 0.0, np.pi])
    moved_m = _SPEED_STD_MPS * abs(off_s)
    across_m = np.hypot(config.range_std_m, moved_m)
    return Measurements.polar(
        normalize_angle(np.arctan2(offset[:, 1], offset[:, 0]) - origin[2]),
        range_m,
        np.minimum(across_m / range_m, np.pi / np.sqrt(3.0)),
        np.hypot(depth_noise_m(range_m, config), across_m),
        origin,
        raised=False,
        person=rows + _BODY_OFFSET,
        hand=-1,
        refuse="drop",
    )
