"""Which body does a raised hand belong to? The nearest person-sized cluster beside its ray.

A raised hand stands beside the body, and a laser at leg height looks past the body at the wall:
the beam at the hand's own bearing is the wrong one to ask.
"""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray, IntArray
from tracker.ranging.people import PersonClusters
from tracker.ranging.rays import HandRays


def nearest_person(rays: HandRays, people: PersonClusters, body_width_m: float) -> IntArray:
    """For each hand the nearest cluster within half a body's width of its ray.

    Args:
        rays: Hands' directions.
        people: Clusters in the same fixed frame.
        body_width_m: Half of it, to each side of the ray, is searched.

    Returns:
        Shape (H,): rows of `people`; -1 where nobody stands there.
    """
    if len(people) == 0:
        return np.full(len(rays.bearing_rad), -1, dtype=np.int64)
    heading = rays.bearing_rad + rays.origin[2]
    along, across = ray_coordinates(people.xy_m, rays.origin[:2], heading)
    beside = (along > 0.0) & (np.abs(across) <= body_width_m / 2)
    distance = np.where(beside, along, np.inf)
    nearest = np.argmin(distance, axis=1)
    return np.where(beside.any(axis=1), nearest, -1)


def ray_coordinates(
    points_m: FloatArray, origin_m: FloatArray, heading_rad: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """How far points lie along rays, and how far to their left.

    Args:
        points_m: Shape (C, 2).
        origin_m: Shape (2,): where all rays begin.
        heading_rad: Shape (H,), in the frame of the points.

    Returns:
        Two arrays of shape (H, C), in meters.
    """
    offset = points_m - origin_m
    direction = np.stack([np.cos(heading_rad), np.sin(heading_rad)], axis=-1)
    left = np.stack([-direction[:, 1], direction[:, 0]], axis=-1)
    return direction @ offset.T, left @ offset.T
