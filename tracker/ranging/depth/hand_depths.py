"""How far is the person whose hand is up? By what the depth image shows of the body.

Where a pose has told the torso, its chest; elsewhere the arm below the wrist. Both windows show
what stands behind the person too: the nearest range at which many readings lie counts.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.camera import CameraModel
from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, Hands
from tracker.geometry import RigidTransform
from tracker.ranging.depth.noise import depth_noise_m
from tracker.ranging.depth.points import DepthPoints
from tracker.ranging.rays import HandRays

#: Windows of the picture, in hand lengths: half their width, and how far they reach up and down
#: from the torso's middle or the wrist. A hand is some .18 m long, a trunk .3 m wide (guesses).
_TORSO_WINDOW = (0.6, 1.2, 0.4)
_ARM_WINDOW = (0.5, 0.0, 1.6)
#: A fist, or a hand seen from its side, looks shorter; windows are made for no less than this.
_LENGTH_MIN_PX = 8.0
#: A body's readings lie within this, and at least so many of the window's do (guesses).
_DEEP_M, _SHARE_MIN, _READINGS_MIN = 0.3, 0.25, 4
#: From the skin of chest or arm to the middle of the body, and how that varies (guesses).
_CHEST_M, _ARM_M, _BODY_STD_M = 0.11, 0.0, 0.06
#: A caller's body, which speaks for itself by its hand, is no farther from there (guess).
_SAME_BODY_M = 0.45


@dataclass(frozen=True, slots=True, eq=False)
class HandDepths:
    """How far hands' owners are; row i is hand i of `Hands`.

    Attributes:
        range_m: Shape (H,): level distance from the color camera to the middle of the body; NaN
            where the depth image does not tell.
        std_m: Shape (H,): its standard deviation.
        xy_m: Shape (H, 2): the body's place in the fixed frame; NaN where it is not told.
    """

    range_m: FloatArray
    std_m: FloatArray
    xy_m: FloatArray

    @property
    def is_known(self) -> BoolArray:
        """Shape (H,)."""
        return np.asarray(np.isfinite(self.range_m))

    def claims(self, bodies_xy_m: FloatArray, counts: BoolArray | bool = True) -> BoolArray:
        """Which bodies are owners of these hands.

        Args:
            bodies_xy_m: Shape (C, 2): their places.
            counts: Shape (H,): the hands that are asked about.

        Returns:
            Shape (C,).
        """
        known = self.xy_m[self.is_known & counts]
        apart = np.linalg.norm(bodies_xy_m[:, None] - known, axis=-1)
        return np.asarray((apart < _SAME_BODY_M).any(axis=1))


def hand_depths(
    hands: Hands,
    rays: HandRays,
    points: DepthPoints,
    camera: CameraModel,
    fixed_from_camera: RigidTransform,
    config: Config,
) -> HandDepths:
    """Ask the depth image how far each hand's owner is.

    Its points are looked at as the color camera would see them, so that it does not matter where
    the depth camera is, nor that it looked a moment earlier or later from a robot that turns.

    Args:
        hands: What perception found.
        rays: Their directions.
        points: What the depth image shows.
        camera: Intrinsics of the full color image.
        fixed_from_camera: The color camera with body axes, at the image's stamp.
        config: The ranging group.
    """
    range_m, count = np.full(len(hands), np.nan), len(hands)
    if count:
        origin_m = np.array(fixed_from_camera.translation_m)
        near = np.flatnonzero(points.range_m <= config.person_range_max_m)
        offset_m = points.xyz_m[:, near].T - origin_m
        pixels = camera.pixels(offset_m @ fixed_from_camera.matrix)
        level_m = np.hypot(offset_m[:, 0], offset_m[:, 1])
        for row in range(count):
            inside = _window(hands, row, pixels, rays.roll_rad)
            range_m[row] = _nearer_mode(level_m[inside])
        range_m += np.where(hands.is_owned, _CHEST_M, _ARM_M)
    heading = rays.origin[2] + rays.bearing_rad
    direction = np.stack([np.cos(heading), np.sin(heading)], axis=-1)
    return HandDepths(
        range_m,
        np.hypot(depth_noise_m(range_m, config), _BODY_STD_M),
        rays.origin[:2] + range_m[:, None] * direction,
    )


def _window(hands: Hands, row: int, pixels: FloatArray, roll_rad: float) -> BoolArray:
    """Which pixels, shape (N, 2), lie where a hand's owner is; shape (N,)."""
    is_owned = bool(hands.is_owned[row])
    middle = hands.torso_px[row] if is_owned else hands.wrist_px[row]
    half, up, down = _TORSO_WINDOW if is_owned else _ARM_WINDOW
    length = max(float(hands.length_px[row]), _LENGTH_MIN_PX)
    right_px, down_px = (pixels - middle).T
    if roll_rad:  # what is level in the room is turned so far in the picture, counter-clockwise
        cos, sin = np.cos(roll_rad), np.sin(roll_rad)
        right_px, down_px = right_px * cos - down_px * sin, right_px * sin + down_px * cos
    with np.errstate(invalid="ignore"):
        inside = (np.abs(right_px) <= half * length) & (down_px >= -up * length)
        return np.asarray(inside & (down_px <= down * length))


def _nearer_mode(range_m: FloatArray) -> float:
    """Middle of the nearest readings that are many; NaN where none are."""
    ordered = np.sort(range_m)
    needed = max(_READINGS_MIN, int(np.ceil(_SHARE_MIN * len(ordered))))
    ends = np.searchsorted(ordered, ordered + _DEEP_M, side="right")
    many = np.flatnonzero(ends - np.arange(len(ordered)) >= needed)
    if not len(many):
        return np.nan
    # Of the windows that begin with the first such reading, the fullest: a few stray readings in
    # front of the body belong to none.
    first = many[0]
    begins = np.arange(first, ends[first])
    best = begins[np.argmax(ends[begins] - begins)]
    return float(np.median(ordered[best : ends[best]]))
