import numpy as np
import pytest

from tracker.camera import CameraModel
from tracker.containers import DepthImage
from tracker.geometry import RigidTransform

CAMERA = CameraModel(460.0, 460.0, 320.0, 240.0, width=640, height=480)


@pytest.fixture
def room():
    """Draws a level depth camera's image: a wall, the floor 1.2 m below, and upright boxes."""

    def draw(*boxes, wall_m=6.0, camera=CAMERA, left_m=0.0, noise=None):
        """Boxes: (x ahead of the fixed origin, y, half width, from, to), heights over the floor.

        The camera stands `left_m` to the left of the origin.
        """
        columns, rows = np.arange(camera.width), np.arange(camera.height)
        aside = (camera.cx - columns) / camera.fx
        down = (rows - camera.cy) / camera.fy
        depth = np.full((camera.height, camera.width), wall_m)
        floor = np.where(down > 0, 1.2 / np.maximum(down, 1e-9), np.inf)
        depth = np.minimum(depth, floor[:, None])
        for x, y, half, low, high in sorted(boxes, reverse=True):
            inside = np.abs(aside * x + left_m - y) <= half
            height = 1.2 - down * x
            is_high = (height >= low) & (height <= high)
            hit = is_high[:, None] & inside & (depth > x)
            depth[hit] = x
        if noise is not None:
            depth = noise(depth)
        return DepthImage.of(1_000_000_000, "camera_link", depth.astype(np.float32))

    return draw


@pytest.fixture
def standing():
    """The depth camera at the height of 1.2 m."""
    return RigidTransform((0.0, 0.0, 1.2))
