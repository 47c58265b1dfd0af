"""How far is the person whose hand is up? By what the depth image shows of the body.

Where a pose has told the torso, its chest; elsewhere the arm below the wrist. Both windows show
what stands behind the person too, and who walks past in front: of the ranges at which many
readings lie, the nearest counts that the hand itself does not speak against: its own readings, or
else its size. Where the body is hidden, the hand's own range serves, less exactly.
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
from tracker.ranging.depth.same_body import are_near
from tracker.ranging.person_range import BESIDE_M, owner_side, size_misfit
from tracker.ranging.rays import HandRays

#: Windows of the picture, in hand lengths: half their width, and how far they reach up and down
#: from the torso's middle or the wrist. A hand is some .18 m long, a trunk .3 m wide (guesses).
_TORSO_WINDOW = (0.6, 1.2, 0.4)
_ARM_WINDOW = (0.5, 0.0, 1.6)
#: The same of the palm, from its middle.
_PALM_WINDOW = (0.3, 0.3, 0.3)
#: A fist, or a hand seen from its side, looks shorter; windows are made for no less than this.
_LENGTH_MIN_PX = 8.0
#: A body's readings lie within this, and at least so many of the window's do (guesses).
_DEEP_M, _SHARE_MIN, _READINGS_MIN = 0.3, 0.25, 4
#: From the skin of chest or arm to the middle of the body, and how that varies (guesses).
_CHEST_M, _ARM_M, _BODY_STD_M = 0.11, 0.0, 0.06
#: A hand is held no farther than this before its owner's chest, and as little behind it; both
#: widen with the noise of the readings (guesses).
_BEFORE_M, _BEHIND_M, _NOISES = 0.6, 0.25, 2.0
#: Where the body is hidden: it stands about so much behind the hand, and that varies (guesses).
_BEHIND_HAND_M, _HAND_STD_M = 0.1, 0.2
#: A farther range counts where the hand's size fits it so much better: two standard deviations.
_MISFIT_MAX = 4.0
_WRIST, _MIDDLE_ROOT = 0, 9


@dataclass(frozen=True, slots=True, eq=False)
class HandDepths:
    """How far hands' owners are; row i is hand i of `Hands`.

    Attributes:
        range_m: Shape (H,): level distance from the color camera to the middle of the body; NaN
            where the depth image does not tell.
        std_m: Shape (H,): its standard deviation.
        bearing_rad: Shape (H,): of the body, as `HandRays` has it: beside the hand, on its thumb's
            side, where the torso is not known.
        xy_m: Shape (H, 2): the body's place in the fixed frame; NaN where it is not told.
        is_strange: Shape (H,): the torso that the pose has told is not at the hand's range, and so
            it is somebody else's, who stands in front.
    """

    range_m: FloatArray
    std_m: FloatArray
    bearing_rad: FloatArray
    xy_m: FloatArray
    is_strange: BoolArray

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
        return are_near(bodies_xy_m, self.xy_m[self.is_known & counts])


def hand_depths(
    hands: Hands,
    rays: HandRays,
    points: DepthPoints,
    camera: CameraModel,
    fixed_from_camera: RigidTransform,
    config: Config,
) -> HandDepths:
    """Measure in the depth image how far each hand's owner is.

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
    count = len(hands)
    range_m, body_std_m = np.full(count, np.nan), np.full(count, _BODY_STD_M)
    is_strange = np.zeros(count, dtype=bool)
    if count:
        origin_m = np.array(fixed_from_camera.translation_m)
        near = np.flatnonzero(points.range_m <= config.person_range_max_m)
        offset_m = points.xyz_m[:, near].T - origin_m
        pixels = camera.pixels(offset_m @ fixed_from_camera.matrix)
        level_m = np.hypot(offset_m[:, 0], offset_m[:, 1])
        for row in range(count):
            body_m = _modes(level_m[_body_window(hands, row, pixels, rays.roll_rad)])
            palm_m = _modes(level_m[_palm_window(hands, row, pixels, rays.roll_rad)])
            of_size = _fits_size(np.concatenate([palm_m, body_m]), hands[row], camera)
            palm_m = palm_m[of_size[: len(palm_m)]][:1]
            if len(palm_m):
                noise_m = _NOISES * depth_noise_m(palm_m, config)
                before_m = body_m - palm_m
                fits = (before_m > -_BEHIND_M - noise_m) & (before_m < _BEFORE_M + noise_m)
            else:
                fits = _fits_size(body_m, hands[row], camera)
            if fits.any():
                range_m[row] = body_m[fits][0] + (_CHEST_M if hands.is_owned[row] else _ARM_M)
            elif len(palm_m):
                is_strange[row] = hands.is_owned[row] and len(body_m) > 0
                range_m[row], body_std_m[row] = palm_m[0] + _BEHIND_HAND_M, _HAND_STD_M
    sense = -1.0 if config.bearing_convention == "spec" else 1.0
    beside_m = sense * BESIDE_M * owner_side(hands, rays.roll_rad)
    bearing_rad = rays.bearing_rad + np.arctan2(beside_m, np.maximum(range_m, BESIDE_M))
    heading = rays.origin[2] + bearing_rad
    direction = np.stack([np.cos(heading), np.sin(heading)], axis=-1)
    return HandDepths(
        range_m,
        np.hypot(depth_noise_m(range_m, config), body_std_m),
        bearing_rad,
        rays.origin[:2] + range_m[:, None] * direction,
        is_strange,
    )


def _fits_size(range_m: FloatArray, hand: Hands, camera: CameraModel) -> BoolArray:
    """Which ranges, shape (K,), fit the size of one hand about as well as the best; shape (K,)."""
    misfit = size_misfit(hand, camera, range_m[None])[0]
    return np.asarray(misfit <= np.min(misfit, initial=np.inf) + _MISFIT_MAX)


def _body_window(hands: Hands, row: int, pixels: FloatArray, roll_rad: float) -> BoolArray:
    """Which pixels, shape (N, 2), lie where a hand's owner is; shape (N,)."""
    is_owned = bool(hands.is_owned[row])
    middle = hands.torso_px[row] if is_owned else hands.wrist_px[row]
    length = max(float(hands.length_px[row]), _LENGTH_MIN_PX)
    return _inside(pixels - middle, _TORSO_WINDOW if is_owned else _ARM_WINDOW, length, roll_rad)


def _palm_window(hands: Hands, row: int, pixels: FloatArray, roll_rad: float) -> BoolArray:
    """Which pixels, shape (N, 2), lie on a hand; shape (N,)."""
    middle = hands.landmarks_px[row, [_WRIST, _MIDDLE_ROOT]].mean(axis=0)
    length = max(float(hands.length_px[row]), _LENGTH_MIN_PX)
    return _inside(pixels - middle, _PALM_WINDOW, length, roll_rad)


def _inside(
    off_px: FloatArray, window: tuple[float, float, float], length: float, roll_rad: float
) -> BoolArray:
    half, up, down = window
    right_px, down_px = off_px.T
    if roll_rad:  # what is level in the room is turned so far in the picture, counter-clockwise
        cos, sin = np.cos(roll_rad), np.sin(roll_rad)
        right_px, down_px = right_px * cos - down_px * sin, right_px * sin + down_px * cos
    with np.errstate(invalid="ignore"):
        inside = (np.abs(right_px) <= half * length) & (down_px >= -up * length)
        return np.asarray(inside & (down_px <= down * length))


def _modes(range_m: FloatArray) -> FloatArray:
    """Ranges at which many readings lie, the nearest first; empty for none."""
    ordered = np.sort(range_m)
    count = len(ordered)
    needed = max(_READINGS_MIN, int(np.ceil(_SHARE_MIN * count)))
    ends = np.searchsorted(ordered, ordered + _DEEP_M, side="right")
    held = ends - np.arange(count)
    modes, row = [], 0
    while row < count:
        if held[row] < needed:
            row += 1
            continue
        # Of the windows that begin with these readings, the fullest: stray readings in front of a
        # body begin none.
        best = row + int(np.argmax(held[row : ends[row]]))
        modes.append(np.median(ordered[best : ends[best]]))
        row = int(ends[best])
    return np.array(modes)
