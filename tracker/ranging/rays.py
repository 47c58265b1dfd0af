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
        bearing_rad: Shape (H,), from the camera's yaw, counter-clockwise; NaN where unknown. That
            of the owner's torso where a pose has told it.
        wrist_bearing_rad: Shape (H,): direction to the wrist, also where `bearing_rad` is that of
            the torso.
        bearing_std_rad: Shape (H,), of the pixel noise alone.
        roll_rad: Of the camera: what is level in the room is turned so far in the picture,
            counter-clockwise.
    """

    origin: FloatArray
    bearing_rad: FloatArray
    wrist_bearing_rad: FloatArray
    bearing_std_rad: FloatArray
    roll_rad: float = 0.0

    @property
    def torso_rad(self) -> FloatArray:
        """Shape (H,): from each hand to the owner's torso, counter-clockwise; 0 where none is."""
        return normalize_angle(self.bearing_rad - self.wrist_bearing_rad)


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

    Returns:
        NaN for hands beyond the lens's range, whose direction nobody knows.
    """
    pixels = np.where(hands.is_owned[:, None], hands.torso_px, hands.wrist_px)
    origin = fixed_from_camera.planar
    bearing = wrist = _bearing_rad(hands.wrist_px, camera, fixed_from_camera)
    if hands.is_owned.any():
        bearing = _bearing_rad(pixels, camera, fixed_from_camera)
    noise_rad = wrist_noise_px(hands.length_px, config) * _turn_per_pixel_rad(
        pixels, camera, fixed_from_camera
    )
    if config.bearing_convention == "spec":
        bearing, wrist = -bearing, -wrist
    noise_rad = np.maximum(noise_rad, 1e-4)
    return HandRays(origin, bearing, wrist, noise_rad, fixed_from_camera.roll_rad)


def _bearing_rad(
    pixels: FloatArray, camera: CameraModel, fixed_from_camera: RigidTransform
) -> FloatArray:
    """Level directions of pixels from the camera's yaw, shape (H,)."""
    level = fixed_from_camera.rotate(camera.rays(pixels))
    return normalize_angle(np.arctan2(level[:, 1], level[:, 0]) - fixed_from_camera.yaw_rad)


def _turn_per_pixel_rad(
    pixels: FloatArray, camera: CameraModel, fixed_from_camera: RigidTransform
) -> FloatArray:
    """How far a pixel of noise turns the bearing, shape (H,); cos^2 / fx for a level pinhole."""
    turns = []
    for half in (np.array([0.5, 0.0]), np.array([0.0, 0.5])):
        ends = (_bearing_rad(pixels + step, camera, fixed_from_camera) for step in (half, -half))
        turns.append(normalize_angle(np.subtract(*ends)))
    return np.hypot(*turns)


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
