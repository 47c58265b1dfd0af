"""Between which bearings does a camera see raised hands? Roll, pitch and yaw are used."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from tracker.camera import CameraModel
from tracker.containers import FloatArray
from tracker.geometry import RigidTransform, normalize_angle

#: Raised hands are seen between these elevations, from cameras at the height of a table or a head;
#: the floor that a camera looks down upon is no place to look for them (guess).
_ELEVATION_RAD = np.radians((-10.0, 40.0))
#: Pixels along each side of the picture that are looked through.
_GRID = 17
#: Directions around the rim of a lens, and how far out they are: just before it ends.
_RIM, _WITHIN_RIM = 64, 0.999


def bearing_span_rad(
    camera: CameraModel, image_size: tuple[int, int], fixed_from_camera: RigidTransform
) -> tuple[float, float]:
    """Bearings of the rightmost and the leftmost place where a raised hand can be.

    Args:
        camera: Intrinsics of the full image.
        image_size: Its width and height in pixels.
        fixed_from_camera: The camera with body axes (x forward) in the fixed frame.

    Returns:
        Counter-clockwise from the camera's yaw: to the right, then to the left. A camera that
        sees no such place gives the span of all that it sees.
    """
    rays = fixed_from_camera.rotate(_grid_rays(camera, image_size))
    elevation = np.arctan2(rays[:, 2], np.hypot(rays[:, 0], rays[:, 1]))
    seen = (elevation >= _ELEVATION_RAD[0]) & (elevation <= _ELEVATION_RAD[1])
    if not seen.any():
        seen[:] = True
    bearing = np.arctan2(rays[seen, 1], rays[seen, 0]) - fixed_from_camera.yaw_rad
    bearing = normalize_angle(bearing)
    return float(bearing.min()), float(bearing.max())


@lru_cache(maxsize=4)
def _grid_rays(camera: CameraModel, image_size: tuple[int, int]) -> FloatArray:
    """Unit vectors all over the picture, shape (G, 3), in the camera's body frame.

    Where the lens ends within the picture, as a fisheye's circle does, its rim is among them.
    """
    columns, rows = (np.linspace(0.0, length, _GRID) for length in image_size)
    pixels = np.stack(np.meshgrid(columns, rows), axis=-1).reshape(-1, 2)
    rays = camera.rays(pixels)
    end_rad = _WITHIN_RIM * camera.lens.max_off_axis_rad
    around = np.linspace(0.0, 2.0 * np.pi, _RIM, endpoint=False)
    aside = np.sin(end_rad) * np.stack([np.cos(around), np.sin(around)], axis=-1)
    rim = np.column_stack([np.full(_RIM, np.cos(end_rad)), aside])
    rim_px = camera.pixels(rim)
    is_shown = ((rim_px >= 0.0) & (rim_px <= image_size)).all(axis=1)
    return np.concatenate([rays[np.isfinite(rays[:, 0])], rim[is_shown]])
