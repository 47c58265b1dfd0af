"""What does a person look like? A friendly flat-shaded figure, painted once per posture.

A figure faces the viewer (or turns its back) on an upright sheet: x to the right, z up from the
floor, in meters, x = 0 at the body's center.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.containers import FloatArray
from tracker.simulation.canvas import Canvas, Color, Sprite
from tracker.simulation.hand_shape import hand_landmarks, paint_hand

_STATURE_M = 1.72  # of the figure that the lengths below draw; a guess at a grown person
_HIP_M = 0.90
_UPPER_ARM_M, _FOREARM_M = 0.27, 0.24


@dataclass(frozen=True, slots=True)
class Look:
    """What stays with a person.

    Attributes:
        stature_m: Height when standing.
        seat_m: Height of the seat; None for somebody who stands.
        right_handed: Raises the right hand.
        skin: Blue, green, red.
        hair: Blue, green, red.
        hair_style: `short`, `long`, `bun` or `bald`.
        shirt: Blue, green, red.
        trousers: Blue, green, red.
    """

    stature_m: float = _STATURE_M
    seat_m: float | None = None
    right_handed: bool = True
    skin: Color = (120, 160, 214)
    hair: Color = (40, 52, 74)
    hair_style: str = "short"
    shirt: Color = (150, 110, 60)
    trousers: Color = (80, 64, 56)

    @property
    def scale(self) -> float:
        """Of every length but the hand's, which is the same for all."""
        return self.stature_m / _STATURE_M

    @property
    def sunk_m(self) -> float:
        """How much lower the trunk is than when standing."""
        return 0.0 if self.seat_m is None else self.scale * _HIP_M - self.seat_m - 0.06


@dataclass(frozen=True, slots=True)
class Arm:
    """Where a figure's arm runs, on its sheet.

    Attributes:
        shoulder_m: x and z.
        elbow_m: x and z.
        wrist_m: x and z.
        hand_rad: Direction of the fingers, from straight up toward the right.
    """

    shoulder_m: tuple[float, float]
    elbow_m: tuple[float, float]
    wrist_m: tuple[float, float]
    hand_rad: float


def bend_arm(look: Look, raised: float, side: float) -> Arm:
    """The arm's joints.

    Args:
        look: Whose arm.
        raised: 0 hangs (or rests on the lap), 1 is up beside the head.
        side: -1 for the arm at the sheet's left, 1 for the one at its right.
    """
    low = (8.0, 2.0, 0.0) if look.seat_m is None else (12.0, -42.0, -60.0)
    high = (78.0, 192.0, 178.0)  # upper arm, forearm, hand; degrees from down, outward
    upper, fore, hand = (np.radians(a + (b - a) * raised) for a, b in zip(low, high, strict=True))
    scale = look.scale
    x, z = 0.175 * scale, 1.385 * scale - look.sunk_m
    elbow_x = x + _UPPER_ARM_M * scale * np.sin(upper)
    elbow_z = z - _UPPER_ARM_M * scale * np.cos(upper)
    wrist_x = elbow_x + _FOREARM_M * scale * np.sin(fore)
    wrist_z = elbow_z - _FOREARM_M * scale * np.cos(fore)
    return Arm(
        (side * x, z),
        (side * float(elbow_x), float(elbow_z)),
        (side * float(wrist_x), float(wrist_z)),
        float(side * (np.pi - hand)),
    )


def raised_hand_landmarks(look: Look, *, from_behind: bool = False) -> FloatArray:
    """Landmarks of the hand that is fully up, shape (21, 2): x_m and z_m on the sheet."""
    side = _raising_side(look, from_behind)
    arm = bend_arm(look, 1.0, side)
    return hand_landmarks(arm.wrist_m, arm.hand_rad, thumb_right=side < 0)


def paint_figure(
    look: Look, raised_steps: tuple[float, ...], *, px_per_m: float, from_behind: bool = False
) -> list[Sprite]:
    """The figure with its arm at several heights.

    Args:
        look: Who it is.
        raised_steps: For each sprite how far the arm is up, from 0 to 1.
        px_per_m: Resolution.
        from_behind: Hair instead of a face, the backs of the hands.
    """
    height = max(look.stature_m - look.sunk_m + 0.1, 1.85 * look.scale - look.sunk_m + 0.1)
    body = Canvas(0.72 * look.scale + 0.05, height, px_per_m)
    side = _raising_side(look, from_behind)
    _paint_legs(body, look)
    if look.seat_m is None:
        _paint_arm(body, look, bend_arm(look, 0.0, -side), -side, from_behind)
    if not from_behind:
        _paint_hair_behind(body, look)
    _paint_trunk(body, look)
    if look.seat_m is not None:
        _paint_arm(body, look, bend_arm(look, 0.0, -side), -side, from_behind)
    _paint_head(body, look, from_behind)
    sprites = []
    for raised in raised_steps:
        canvas = body.copy()
        _paint_arm(canvas, look, bend_arm(look, raised, side), side, from_behind)
        sprites.append(canvas.sprite())
    return sprites


def _raising_side(look: Look, from_behind: bool) -> float:
    return -1.0 if look.right_handed != from_behind else 1.0


def _paint_legs(canvas: Canvas, look: Look) -> None:
    scale, shoe = look.scale, (46, 44, 48)
    for side in (-1.0, 1.0):
        foot = 0.10 * side
        canvas.paint([[(foot, 0.035, 0.035), (foot * 1.25, 0.03, 0.035)]], shoe, 0.03)
        if look.seat_m is None:
            knee, hip = (foot, 0.48 * scale), (0.085 * side, 0.86 * scale)
            canvas.paint(
                [
                    [(foot, 0.09, 0.045), (*knee, 0.06)],
                    [(*knee, 0.06), (*hip, 0.085)],
                ],
                look.trousers,
                0.06,
            )
        else:
            seat = look.seat_m
            canvas.paint([[(foot, 0.09, 0.045), (foot, seat, 0.06)]], look.trousers, 0.05)
    if look.seat_m is not None:
        stool = (58, 84, 116)
        canvas.paint([[(-0.19, look.seat_m - 0.03, 0.02), (0.19, look.seat_m - 0.03, 0.02)]],
                     stool, 0.02)  # fmt: skip
        for side in (-1.0, 1.0):
            post = [(0.17 * side, look.seat_m - 0.03, 0.014), (0.20 * side, 0.02, 0.014)]
            canvas.paint([post], stool, 0.012)


def _paint_trunk(canvas: Canvas, look: Look) -> None:
    scale, sunk = look.scale, look.sunk_m

    def up(x: float, z: float, radius: float) -> tuple[float, float, float]:
        return (x * scale, z * scale - sunk, radius * scale)

    canvas.paint([[up(-0.09, 0.91, 0.085), up(0.09, 0.91, 0.085)]], look.trousers, 0.06)
    if look.seat_m is not None:
        for side in (-1.0, 1.0):  # thighs toward the viewer
            thighs = [up(0.075 * side, 0.91, 0.08), (0.105 * side, look.seat_m + 0.01, 0.075)]
            canvas.paint([thighs], look.trousers, 0.07)
    waist, chest = 0.14, 0.135
    canvas.paint(
        [
            [up(-0.10, 0.97, 0.065), up(0.10, 0.97, 0.065), up(-waist + 0.07, 1.12, 0.08),
             up(waist - 0.07, 1.12, 0.08), up(-chest, 1.385, 0.058), up(chest, 1.385, 0.058),
             up(0.0, 1.43, 0.05)],
        ],
        look.shirt,
        0.09,
    )  # fmt: skip
    canvas.paint([[up(0.0, 1.50, 0.047), up(0.0, 1.425, 0.052)]], look.skin, 0.05)


def _paint_arm(canvas: Canvas, look: Look, arm: Arm, side: float, from_behind: bool) -> None:
    scale, skin = look.scale, look.skin
    middle = tuple((a + b) / 2 for a, b in zip(arm.shoulder_m, arm.elbow_m, strict=True))
    canvas.paint(
        [
            [(*arm.shoulder_m, 0.042 * scale), (*arm.elbow_m, 0.037 * scale)],
            [(*arm.elbow_m, 0.037 * scale), (*arm.wrist_m, 0.025)],
        ],
        skin,
        0.035,
    )
    canvas.paint(
        [[(*arm.shoulder_m, 0.060 * scale), (middle[0], middle[1], 0.056 * scale)]],
        look.shirt,
        0.05,
    )
    # Raised: palm toward the viewer and thumb toward the head. Hanging: the back and the nails.
    is_up = abs(arm.hand_rad) < np.pi / 2
    paint_hand(
        canvas,
        arm.wrist_m,
        arm.hand_rad,
        skin,
        thumb_right=side < 0 if is_up else side > 0,
        palm_visible=is_up and not from_behind,
    )


def _paint_hair_behind(canvas: Canvas, look: Look) -> None:
    scale, center = look.scale, 1.595 * look.scale - look.sunk_m
    if look.hair_style == "bun":
        canvas.paint([[(0.0, center + 0.155 * scale, 0.042 * scale)]], look.hair, 0.04)
    if look.hair_style == "long":
        lock = [(0.062, 0.05, 0.06), (0.082, -0.15, 0.05)]
        discs = [
            (s * x * scale, center + z * scale, r * scale) for x, z, r in lock for s in (-1, 1)
        ]
        canvas.paint([discs], look.hair, 0.04)


def _paint_head(canvas: Canvas, look: Look, from_behind: bool) -> None:
    scale = look.scale
    center = 1.595 * scale - look.sunk_m

    def at(x: float, z: float, radius: float) -> tuple[float, float, float]:
        return (x * scale, center + z * scale, radius * scale)

    skin, hair = look.skin, look.hair
    shadow = (int(skin[0] * 0.74), int(skin[1] * 0.78), int(skin[2] * 0.86))
    has_hair = look.hair_style != "bald"
    for side in (-1.0, 1.0):
        canvas.paint([[at(0.092 * side, 0.0, 0.018), at(0.090 * side, -0.02, 0.014)]], skin, 0.012)
    if has_hair:
        canvas.paint([[at(0.0, 0.042, 0.099)]], hair, 0.06)
    canvas.paint([[at(0.0, 0.022, 0.090), at(-0.03, -0.062, 0.042), at(0.03, -0.062, 0.042)]],
                 skin, 0.05, flat=0.25)  # fmt: skip
    if from_behind:
        _paint_hair_behind(canvas, look)
        if has_hair:
            canvas.paint([[at(0.0, 0.03, 0.098), at(-0.03, -0.05, 0.05), at(0.03, -0.05, 0.05)]],
                         hair, 0.07)  # fmt: skip
        return
    if has_hair:
        canvas.paint([[at(-0.055, 0.082, 0.032), at(0.045, 0.098, 0.030), at(0.0, 0.107, 0.030)],
                      [at(0.045, 0.098, 0.030), at(0.070, 0.065, 0.020)]], hair, 0.03)  # fmt: skip
    for side in (-1.0, 1.0):
        x = 0.036 * side
        canvas.paint([[at(x - 0.005, 0.004, 0.0115), at(x + 0.005, 0.004, 0.0115)]],
                     (242, 244, 246), 0.004, flat=0.7)  # fmt: skip
        canvas.paint([[at(x, 0.003, 0.0085)]], (44, 52, 62), 0.004, flat=0.6)
        canvas.paint([[at(x - 0.002, 0.007, 0.0025)]], (255, 255, 255), 0.002, flat=1.0)
        brow = [at(x + dx, 0.030 - 0.3 * abs(dx), 0)[:2] for dx in (-0.017, 0.0, 0.017)]
        canvas.line(brow, hair if has_hair else shadow, 0.006)
        blush = [int(0.72 * a + 0.28 * b) for a, b in zip(skin, (80, 90, 220), strict=True)]
        canvas.paint([[at(0.052 * side, -0.032, 0.014)]], (blush[0], blush[1], blush[2]), 0.01,
                     flat=0.9)  # fmt: skip
    canvas.line([at(0.003, 0.0, 0)[:2], at(0.010, -0.024, 0)[:2], at(-0.003, -0.027, 0)[:2]],
                shadow, 0.005)  # fmt: skip
    smile = [at(float(x), -0.050 - 0.014 * float(np.cos(x / 0.028 * np.pi / 2)), 0)[:2]
             for x in np.linspace(-0.028, 0.028, 9)]  # fmt: skip
    canvas.line(smile, (58, 50, 118), 0.008)
