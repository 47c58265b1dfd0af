"""Where in the picture would people's raised hands be? Windows around their upper bodies."""

from __future__ import annotations

import numpy as np

from tracker.camera import CameraModel
from tracker.containers import FloatArray
from tracker.geometry import RigidTransform
from tracker.lens import LensKind

#: Above the floor: from the raised hand of somebody who sits to that of somebody tall who stands.
HEIGHTS_M = (0.9, 2.2)
#: Half a window: an arm that is up ends within this to the left or right of the body's middle.
BESIDE_M = 0.65
#: Nobody nearer fits into the picture; the whole-frame search is for them.
_NEAR_M = 0.5


def expected_hands(
    xy_m: FloatArray, camera: CameraModel, fixed_from_camera: RigidTransform
) -> FloatArray:
    """Project the space around people's heads and shoulders into the picture.

    Args:
        xy_m: Shape (N, 2): people in the fixed frame, whose z is 0 on the floor.
        camera: Intrinsics of the full image.
        fixed_from_camera: The camera with body axes (x forward); `body_pose`.

    Returns:
        Shape (K, 4): x_min, y_min, x_max, y_max in pixels, of those in front of the camera, in
        order; they may reach beyond the picture.
    """
    camera_from_fixed = fixed_from_camera.inverse()
    middle_m = np.full((len(xy_m), 3), sum(HEIGHTS_M) / 2)
    middle_m[:, :2] = xy_m
    ahead, left, up = camera_from_fixed.apply(middle_m).T
    sees_aside = camera.lens.kind is LensKind.FISHEYE
    in_front = (np.hypot(ahead, left) if sees_aside else ahead) > _NEAR_M
    half_height_m = (HEIGHTS_M[1] - HEIGHTS_M[0]) / 2
    corners_m = [
        np.stack([ahead, left + aside, up + above], axis=-1)[in_front]
        for aside in (-BESIDE_M, BESIDE_M)
        for above in (-half_height_m, half_height_m)
    ]
    corners_px = np.stack([camera.pixels(corner) for corner in corners_m], axis=1)
    is_seen = np.isfinite(corners_px)
    first = np.min(corners_px, axis=1, where=is_seen, initial=np.inf)
    last = np.max(corners_px, axis=1, where=is_seen, initial=-np.inf)
    return np.concatenate([first, last], axis=-1)[is_seen.any(axis=(1, 2))]
