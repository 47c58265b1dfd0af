"""In which direction of the map does a hand stand? From the wrist's pixel to a level bearing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.camera import CameraModel
from tracker.config import Config
from tracker.containers import FloatArray, Hands
from tracker.geometry import RigidTransform, normalize_angle

#: The quaternion that turns body axes (x forward) into optical ones (z forward, y down).
_OPTICAL_FROM_BODY = RigidTransform(quaternion_xyzw=(0.5, -0.5, 0.5, 0.5))

#: The wrist under image noise and shifts of half a pixel: in pixels, and in lengths of the hand.
#: Measured on hands of 12 to 83 px: 0.3 px at 12-41 px, 0.4-0.65 px at 60-83 px.
RANDOM_STD_PX, RANDOM_STD_SHARE = 0.3, 0.005


@dataclass(frozen=True, slots=True, eq=False)
class HandRays:
    """Level directions in which hands stand; row i is hand i of `Hands`.

    Attributes:
        origin: x_m, y_m, yaw_rad of the camera in the fixed frame.
        bearing_rad: Shape (H,), from the camera's yaw, counter-clockwise.
        bearing_std_rad: Shape (H,), of the pixel noise alone.
        roll_rad: Of the camera: what is level in the room is turned so far in the picture,
            counter-clockwise.
    """

    origin: FloatArray
    bearing_rad: FloatArray
    bearing_std_rad: FloatArray
    roll_rad: float = 0.0


def hand_rays(
    hands: Hands, camera: CameraModel, fixed_from_camera: RigidTransform, config: Config
) -> HandRays:
    """Turn each hand's pixel into a bearing in the plane in which the robot drives.

    The pixel is the middle of its owner's torso where a pose has told it, the wrist elsewhere.

    The pixel is undistorted, its ray turned by the camera's whole attitude and projected onto the
    plane. For a level camera that is minus the angle of equation 1 (plus, with
    `bearing_convention: spec`).

    Args:
        hands: What perception found.
        camera: Intrinsics of the full image.
        fixed_from_camera: The camera with body axes (x forward) in the fixed frame; `body_pose`.
        config: `bearing_convention` and the wrist's noise, `wrist_noise_px`.
    """
    rays = camera.rays(np.where(hands.is_owned[:, None], hands.torso_px, hands.wrist_px))
    level = fixed_from_camera.rotate(rays)
    origin = fixed_from_camera.planar
    bearing = normalize_angle(np.arctan2(level[:, 1], level[:, 0]) - origin[2])
    if config.bearing_convention == "spec":
        bearing = -bearing
    # d(bearing) / d(column) of a pinhole is cos^2 / fx; a ray that climbs turns 1 / level faster.
    level_share = np.maximum(np.hypot(level[:, 0], level[:, 1]), 0.1)
    noise_px = wrist_noise_px(hands.length_px, config)
    std = noise_px / camera.fx * np.cos(bearing) ** 2 / level_share
    return HandRays(origin, bearing, np.maximum(std, 1e-4), fixed_from_camera.roll_rad)


def wrist_noise_px(length_px: FloatArray, config: Config) -> FloatArray:
    """Standard deviation of the wrist's column, by the size of the hand.

    What differs from image to image, and the larger error that stays while a hand is followed:
    the model always sees this hand's wrist a little to one side. The filter is told of their sum.

    Args:
        length_px: Shape (H,): from the wrist to the middle finger's tip.
        config: `wrist_std_px` and `wrist_std_share`.
    """
    random = RANDOM_STD_PX + RANDOM_STD_SHARE * length_px
    lasting = config.wrist_std_px + config.wrist_std_share * length_px
    return np.asarray(np.hypot(random, lasting))


def body_pose(fixed_from_frame: RigidTransform, frame: str, axes: str) -> RigidTransform:
    """The camera's pose with body axes (x forward), whatever axes its frame has.

    Args:
        fixed_from_frame: As looked up.
        frame: The frame's name, which decides where `axes` is `auto`.
        axes: `Config.camera_axes`.
    """
    is_optical = axes == "optical" or (axes == "auto" and "optical" in frame)
    return fixed_from_frame @ _OPTICAL_FROM_BODY if is_optical else fixed_from_frame
