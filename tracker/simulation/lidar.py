"""What does a planar scanner see? Rays against circles and straight walls."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray, Scan
from tracker.geometry import RigidTransform
from tracker.simulation.legs import chair_legs, table_posts
from tracker.simulation.motion import People
from tracker.simulation.scene import Scene


class ScanSimulator:
    """The scanner of one scene.

    Args:
        scene: Its walls, tables and chairs stand still.
        rng: Range noise and drop-outs.
    """

    def __init__(self, scene: Scene, rng: np.random.Generator) -> None:
        self._laser = scene.laser
        self._rng = rng
        at_height = [wall for wall in scene.walls if wall.height_m > scene.laser.z_m]
        self._segments = np.array(
            [segment for wall in at_height for segment in wall.segments]
        ).reshape(-1, 4)
        self._posts = np.array(
            [post for table in scene.tables for post in table_posts(table)]
            + [leg for chair in scene.chairs for leg in chair_legs(chair)]
        ).reshape(-1, 3)

    def scan(self, stamp_ns: int, map_from_laser: RigidTransform, people: People) -> Scan:
        """One turn; all beams at one instant."""
        laser = self._laser
        beams = round(360.0 / laser.step_deg)
        x, y, yaw = map_from_laser.planar
        first, step = np.radians(laser.first_beam_deg), np.radians(laser.step_deg)
        angles = first + step * np.arange(beams)
        circles = np.concatenate([self._posts, people.legs.reshape(-1, 3)])
        ranges = cast_rays((x, y), yaw + angles, circles, self._segments)
        ranges = ranges + self._rng.normal(0.0, 1.0, beams) * laser.noise_m
        ranges[self._rng.random(beams) < laser.dropout] = np.inf
        ranges[ranges > laser.range_max_m] = np.inf
        return Scan(
            stamp_ns,
            laser.frame,
            float(first),
            float(step),
            laser.range_min_m,
            laser.range_max_m,
            np.maximum(ranges, 0.0),
        )


def cast_rays(
    origin_m: tuple[float, float],
    angles_rad: FloatArray,
    circles: FloatArray,
    segments: FloatArray,
) -> FloatArray:
    """Distance to the nearest thing along each ray.

    Args:
        origin_m: Where the rays start.
        angles_rad: Shape (B,): their directions, in the frame of the things.
        circles: Shape (C, 3): x_m, y_m, radius_m.
        segments: Shape (S, 4): x_m, y_m of both ends.

    Returns:
        Shape (B,), in meters; infinite where nothing is hit.
    """
    directions = np.stack([np.cos(angles_rad), np.sin(angles_rad)], axis=-1)
    nearest = np.full(len(angles_rad), np.inf)
    if len(circles):
        to_center = circles[:, :2] - origin_m
        along = directions @ to_center.T  # (B, C)
        across = _cross(directions[:, None], to_center[None])
        inside = circles[:, 2] ** 2 - across**2
        half_chord = np.sqrt(np.maximum(inside, 0.0))
        entry, leave = along - half_chord, along + half_chord
        hit = np.where(entry > 0.0, entry, leave)
        hit = np.where((inside >= 0.0) & (hit > 0.0), hit, np.inf)
        nearest = np.minimum(nearest, hit.min(axis=1))
    if len(segments):
        start = segments[:, :2] - origin_m
        span = segments[:, 2:] - segments[:, :2]
        slant = _cross(directions[:, None], span[None])  # (B, S); 0 where parallel
        safe = np.where(slant == 0.0, 1.0, slant)
        distance = _cross(start, span)[None] / safe
        share = _cross(start[None], directions[:, None]) / safe
        met = (slant != 0.0) & (distance > 0.0) & (share >= 0.0) & (share <= 1.0)
        nearest = np.minimum(nearest, np.where(met, distance, np.inf).min(axis=1))
    return nearest


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    product: FloatArray = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return product
