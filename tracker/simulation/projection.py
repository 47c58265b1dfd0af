"""Where in the picture is a point of the room? A level pinhole camera, and planes seen by it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.containers import FloatArray
from tracker.geometry import RigidTransform
from tracker.simulation.scene import Camera

#: Nothing nearer than this is drawn.
NEAR_M = 0.08


@dataclass(frozen=True, slots=True)
class Viewpoint:
    """The camera at one instant.

    Attributes:
        camera: Its intrinsics.
        x_m: Place in the map.
        y_m: Place in the map.
        z_m: Height above the floor.
        yaw_rad: Where it looks, in the map.
    """

    camera: Camera
    x_m: float
    y_m: float
    z_m: float
    yaw_rad: float

    @staticmethod
    def of(camera: Camera, map_from_camera: RigidTransform) -> Viewpoint:
        """The viewpoint of a camera whose body frame (x forward) stands level in the map."""
        x, y, z = map_from_camera.translation_m
        return Viewpoint(camera, x, y, z, map_from_camera.yaw_rad)

    def forward_left(self, xy_m: FloatArray) -> FloatArray:
        """Places of the map, shape (..., 2), as meters ahead of the camera and to its left."""
        cosine, sine = np.cos(self.yaw_rad), np.sin(self.yaw_rad)
        dx, dy = xy_m[..., 0] - self.x_m, xy_m[..., 1] - self.y_m
        ahead_left = np.empty(np.shape(xy_m))
        ahead_left[..., 0], ahead_left[..., 1] = dx * cosine + dy * sine, dy * cosine - dx * sine
        return ahead_left

    def pixels(self, forward_left: FloatArray, z_m: FloatArray | float) -> FloatArray:
        """Column and row, shape (..., 2), of points given ahead, left and above the floor."""
        camera = self.camera
        ahead, left = forward_left[..., 0], forward_left[..., 1]
        pixels = np.empty(np.shape(forward_left))
        pixels[..., 0] = camera.cx - camera.fx * left / ahead
        pixels[..., 1] = camera.cy + camera.fy * (self.z_m - z_m) / ahead
        return pixels

    def is_in_picture(self, pixels: FloatArray) -> bool:
        """Whether all of some points fall into the picture."""
        size = (self.camera.width, self.camera.height)
        return bool(np.all((pixels >= 0.0) & (pixels <= np.subtract(size, 1))))

    def pixels_from_wall(self, start: FloatArray, end: FloatArray) -> FloatArray:
        """Homography, shape (3, 3): (meters from `start`, height) of an upright wall to pixels.

        Args:
            start: Shape (2,): one end, ahead and left of the camera.
            end: Shape (2,): the other.
        """
        ahead, left = (end - start) / np.linalg.norm(end - start)
        in_camera = np.array(
            [[left, 0.0, start[1]], [0.0, 1.0, -self.z_m], [ahead, 0.0, start[0]]]
        )
        return np.asarray(self._intrinsics() @ in_camera)

    def pixels_from_floor(self) -> FloatArray:
        """Homography, shape (3, 3): x_m, y_m of the map's floor to pixels."""
        cosine, sine = np.cos(self.yaw_rad), np.sin(self.yaw_rad)
        ahead = [cosine, sine, -self.x_m * cosine - self.y_m * sine]
        left = [-sine, cosine, self.x_m * sine - self.y_m * cosine]
        return np.asarray(self._intrinsics() @ np.array([left, [0.0, 0.0, -self.z_m], ahead]))

    def _intrinsics(self) -> FloatArray:
        """Of a vector (left, up, ahead)."""
        camera = self.camera
        return np.array(
            [[-camera.fx, 0.0, camera.cx], [0.0, -camera.fy, camera.cy], [0.0, 0.0, 1.0]]
        )


def clip_to_front(forward_left: FloatArray, *, closed: bool) -> FloatArray:
    """The part of an outline that lies ahead of the camera, by Sutherland and Hodgman.

    Args:
        forward_left: Shape (N, 2): corners ahead and left of the camera.
        closed: A polygon; else a run of straight pieces (of two corners, here).

    Returns:
        Shape (M, 2); empty where all of it lies behind.
    """
    kept = []
    count = len(forward_left)
    for row in range(count):
        corner = forward_left[row]
        if row == 0 and not closed:
            if corner[0] >= NEAR_M:
                kept.append(corner)
            continue
        before = forward_left[row - 1]
        if (before[0] >= NEAR_M) != (corner[0] >= NEAR_M):
            share = (NEAR_M - before[0]) / (corner[0] - before[0])
            kept.append(before + share * (corner - before))
        if corner[0] >= NEAR_M:
            kept.append(corner)
    return np.array(kept).reshape(-1, 2)
