"""Where in the room is what a depth image shows? A grid of its pixels, as points."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from tracker.camera import CameraModel
from tracker.containers import DepthImage, FloatArray, depth_in_meters
from tracker.errors import ShapeError
from tracker.geometry import RigidTransform

#: Of the columns, and with them of the rows, about so many are looked at: at 5 m, points of a
#: camera of 70 degrees are 4 cm apart, so that a body still shows a hundred.
_COLUMNS = 160
#: Fewer rows or columns of the grid show nobody.
_LEAST = 4


@dataclass(frozen=True, slots=True, eq=False)
class DepthPoints:
    """What a depth image shows, in the fixed frame; row i of each array is one pixel of a grid.

    Attributes:
        stamp_ns: When it was taken.
        frame_id: The depth camera's frame.
        pose: Shape (3,): x_m, y_m, yaw_rad of the depth camera.
        xyz_m: Shape (3, N), float32; NaN where there is no reading.
        range_m: Shape (N,), float32: level distance from the camera.
        heading_rad: Shape (N,), float32: level direction of each pixel's ray from the camera's
            yaw, counter-clockwise, whether it has a reading or not.
        spacing_rad: From one column of the grid to the next, where that is widest.
        floor_z_m: Height of the floor in the fixed frame; NaN where that is not known.
        camera_z_m: Height of the camera in the fixed frame.
    """

    stamp_ns: int
    frame_id: str
    pose: FloatArray
    xyz_m: NDArray[np.float32]
    range_m: NDArray[np.float32]
    heading_rad: NDArray[np.float32]
    spacing_rad: float
    floor_z_m: float
    camera_z_m: float


def depth_points(
    image: DepthImage,
    camera: CameraModel,
    fixed_from_camera: RigidTransform,
    *,
    floor_z_m: float = 0.0,
) -> DepthPoints:
    """Look at a grid of a depth image's pixels.

    Args:
        image: The depth image.
        camera: Intrinsics of the depth image, of whatever size.
        fixed_from_camera: The depth camera with body axes (x forward) in the fixed frame, at the
            depth image's stamp.
        floor_z_m: Height of the floor in the fixed frame; NaN where that is not known.

    Raises:
        RecordingError: The image cannot be unpacked.
        ShapeError: It is no depth image.
        ConfigError: The intrinsics belong to a picture of another shape.
    """
    pixels = image.read()
    height, width = pixels.shape[:2]
    step = max(round(width / _COLUMNS), 1)
    if min(height // step, width // step) < _LEAST:
        raise ShapeError(
            f"A depth image of {width} x {height} pixels came, too small to show anybody; is it "
            "the right topic?"
        )
    half = step // 2
    depth_m = depth_in_meters(pixels[half::step, half::step]).reshape(-1)
    rays, spacing_rad = _grid_rays(camera.for_picture(width, height), step)
    turned = fixed_from_camera.matrix.astype(np.float32) @ rays
    xyz_m = turned * depth_m
    range_m = np.hypot(xyz_m[0], xyz_m[1])
    yaw_rad = fixed_from_camera.yaw_rad
    cos, sin = np.float32(np.cos(yaw_rad)), np.float32(np.sin(yaw_rad))
    ahead, left = turned[0] * cos + turned[1] * sin, turned[1] * cos - turned[0] * sin
    heading_rad = np.arctan2(left, ahead)
    xyz_m += np.array(fixed_from_camera.translation_m, dtype=np.float32)[:, None]
    return DepthPoints(
        image.stamp_ns,
        image.frame_id,
        fixed_from_camera.planar,
        xyz_m,
        range_m,
        heading_rad,
        spacing_rad,
        floor_z_m,
        fixed_from_camera.translation_m[2],
    )


@lru_cache(maxsize=4)
def _grid_rays(camera: CameraModel, step: int) -> tuple[NDArray[np.float32], float]:
    """Rays of the grid, shape (3, N), scaled to one meter ahead; and the columns' widest spacing.

    In the camera's body frame. NaN where a lens shows nothing, or nothing ahead.
    """
    assert camera.width is not None
    assert camera.height is not None
    half = step // 2
    columns, rows = np.arange(half, camera.width, step), np.arange(half, camera.height, step)
    grid = np.stack(np.meshgrid(columns, rows), axis=-1).reshape(-1, 2)
    rays = camera.rays(grid)
    ahead = np.where(rays[:, :1] > 0.0, rays[:, :1], np.nan)
    across = np.arctan2(rays[:, 1], rays[:, 0]).reshape(len(rows), len(columns))
    spacing_rad = float(np.nanmax(np.abs(np.diff(across[len(rows) // 2]))))
    return (rays / ahead).T.astype(np.float32).copy(), spacing_rad
