"""What does a person look like? A friendly flat-shaded figure, painted once per posture.

A figure faces the viewer (or turns its back) on an upright sheet: x to the right, z up from the
floor, in meters, x = 0 at the body's center.
"""

from __future__ import annotations

import numpy as np

from tracker.simulation.activities import ACTIVITIES, Gesture
from tracker.simulation.rendering.arm import Arm, bend_arm, raising_side, reach, top_m
from tracker.simulation.rendering.canvas import Canvas, Sprite
from tracker.simulation.rendering.grip import paint_grip
from tracker.simulation.rendering.hand_shape import paint_hand
from tracker.simulation.rendering.look import Look


def paint_figure(
    look: Look,
    steps: tuple[tuple[float, float], ...],
    *,
    px_per_m: float,
    from_behind: bool = False,
) -> list[Sprite]:
    """The figure with its arm at several heights.

    Args:
        look: Who it is.
        steps: For each sprite how far the arm is up, from 0 to 1, and how far it swings in a
            wave, from -1 to 1.
        px_per_m: Resolution.
        from_behind: Hair instead of a face, the backs of the hands.
    """
    side = raising_side(look, from_behind=from_behind)
    body = _paint_body(look, px_per_m, from_behind, resting=(-side,))
    sprites = []
    for raised, swing in steps:
        canvas = body.copy()
        arm = bend_arm(look, raised, side, swing)
        _paint_arm(canvas, look, arm, side, from_behind, calls=raised > 0.0)
        sprites.append(canvas.sprite())
    return sprites


def paint_activity(look: Look, what: str, *, px_per_m: float) -> list[Sprite]:
    """The figure busy with something else than calling, from the front.

    Args:
        look: Who it is.
        what: One of `ACTIVITIES`; there is a sprite for each of its moments.
        px_per_m: Resolution.
    """
    side = raising_side(look, from_behind=False)
    moments = ACTIVITIES[what]
    both = any(moment.other is not None for moment in moments)
    body = _paint_body(look, px_per_m, False, resting=() if both else (-side,))
    sprites = []
    for moment in moments:
        canvas = body.copy()
        if moment.other is not None:
            _paint_gesture(canvas, look, moment.other, -side)
        _paint_gesture(canvas, look, moment.hand, side)
        sprites.append(canvas.sprite())
    return sprites


def _paint_body(
    look: Look, px_per_m: float, from_behind: bool, resting: tuple[float, ...]
) -> Canvas:
    """All but the arms that do something; `resting` are the sides of those that do nothing."""
    body = Canvas(0.72 * look.scale + 0.05, top_m(look) + 0.1, px_per_m)
    _paint_legs(body, look)
    if look.seat_m is None:
        for side in resting:
            _paint_arm(body, look, bend_arm(look, 0.0, side), side, from_behind)
    if not from_behind:
        _paint_hair_behind(body, look)
    _paint_trunk(body, look)
    if look.seat_m is not None:
        for side in resting:
            _paint_arm(body, look, bend_arm(look, 0.0, side), side, from_behind)
    _paint_head(body, look, from_behind)
    return body


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
    if look.seat_m is not None and look.has_stool:
        stool = (58, 84, 116)
        canvas.paint([[(-0.19, look.seat_m - 0.03, 0.02), (0.19, look.seat_m - 0.03, 0.02)]],
                     stool, 0.02)  # fmt: skip
        for side in (-1.0, 1.0):
            post = [(0.17 * side, look.seat_m - 0.03, 0.014), (0.20 * side, 0.02, 0.014)]
            canvas.paint([post], stool, 0.012)


def _paint_trunk(canvas: Canvas, look: Look) -> None:
    scale, sunk, build = look.scale, look.sunk_m, look.build

    def up(x: float, z: float, radius: float) -> tuple[float, float, float]:
        return (x * scale * build, z * scale - sunk, radius * scale)

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


def _paint_arm(
    canvas: Canvas, look: Look, arm: Arm, side: float, from_behind: bool, *, calls: bool = False
) -> None:
    _paint_limb(canvas, look, arm)
    if calls and look.sign != "palm":
        paint_grip(
            canvas, arm.wrist_m, arm.hand_rad, look.skin,
            thumb_right=side < 0, length_m=look.hand_m, points=look.sign == "finger",
        )  # fmt: skip
        return
    # Raised: palm toward the viewer and thumb toward the head. Hanging: the back and the nails.
    is_up = abs(arm.hand_rad) < np.pi / 2
    paint_hand(
        canvas,
        arm.wrist_m,
        arm.hand_rad,
        look.skin,
        thumb_right=side < 0 if is_up else side > 0,
        palm_visible=is_up and not from_behind,
        length_m=look.hand_m,
        spread=look.spread,
    )


def _paint_gesture(canvas: Canvas, look: Look, gesture: Gesture, side: float) -> None:
    arm = reach(look, gesture.wrist_m, gesture.hand_deg, side)
    _paint_limb(canvas, look, arm)
    if gesture.holds is not None:
        paint_grip(
            canvas, arm.wrist_m, arm.hand_rad, look.skin,
            thumb_right=side < 0, length_m=look.hand_m,
            holds=None if gesture.holds == "fist" else gesture.holds,
        )  # fmt: skip
        return
    paint_hand(
        canvas, arm.wrist_m, arm.hand_rad, look.skin,
        thumb_right=(side < 0) == gesture.palm_visible, palm_visible=gesture.palm_visible,
        length_m=look.hand_m, spread=gesture.spread,
    )  # fmt: skip


def _paint_limb(canvas: Canvas, look: Look, arm: Arm) -> None:
    scale, skin = look.scale, look.skin
    wide = scale * look.build
    middle = tuple((a + b) / 2 for a, b in zip(arm.shoulder_m, arm.elbow_m, strict=True))
    canvas.paint(
        [
            [(*arm.shoulder_m, 0.042 * wide), (*arm.elbow_m, 0.037 * wide)],
            [(*arm.elbow_m, 0.037 * wide), (*arm.wrist_m, 0.025)],
        ],
        skin,
        0.035,
    )
    if look.sleeve == "short":
        cloth = [[(*arm.shoulder_m, 0.060 * wide), (middle[0], middle[1], 0.056 * wide)]]
        canvas.paint(cloth, look.shirt, 0.05)
    elif look.sleeve == "long":
        cuff = tuple(0.12 * a + 0.88 * b for a, b in zip(arm.elbow_m, arm.wrist_m, strict=True))
        cloth = [
            [(*arm.shoulder_m, 0.058 * wide), (*arm.elbow_m, 0.048 * wide)],
            [(*arm.elbow_m, 0.048 * wide), (cuff[0], cuff[1], 0.036)],
        ]
        canvas.paint(cloth, look.shirt, 0.05)


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
