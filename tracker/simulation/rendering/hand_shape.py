"""What does a hand look like? Twenty-one landmarks, fingers of swept discs, palm or back."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray
from tracker.simulation.rendering.canvas import Canvas, Color, Disc

#: From the wrist to the middle finger's tip.
HAND_LENGTH_M = 0.18

#: A right hand's palm as its owner's opposite sees it: fingers up, thumb to the right. Shape
#: (21, 2): right and up in hand lengths from the wrist, in MediaPipe's order. Proportions: drawn
#: by eye after adult hands.
LANDMARKS = np.array(
    [
        (0.00, 0.00),
        (0.15, 0.10), (0.27, 0.24), (0.37, 0.38), (0.45, 0.50),
        (0.16, 0.50), (0.21, 0.70), (0.235, 0.82), (0.25, 0.93),
        (0.03, 0.53), (0.04, 0.76), (0.04, 0.89), (0.04, 1.00),
        (-0.09, 0.50), (-0.13, 0.71), (-0.15, 0.83), (-0.17, 0.935),
        (-0.20, 0.44), (-0.27, 0.59), (-0.31, 0.68), (-0.345, 0.77),
    ]
)  # fmt: skip
_FINGERS = ((5, 6, 7, 8), (9, 10, 11, 12), (13, 14, 15, 16), (17, 18, 19, 20))
_FINGER_RADII = (0.060, 0.053, 0.048, 0.042)
_THUMB_RADII = (0.085, 0.070, 0.058, 0.046)
PALM: tuple[Disc, ...] = (
    (0.0, 0.06, 0.12), (0.13, 0.14, 0.07), (0.13, 0.45, 0.075), (0.03, 0.48, 0.075),
    (-0.09, 0.46, 0.075), (-0.165, 0.40, 0.07), (-0.11, 0.14, 0.07),
)  # fmt: skip
_CREASES = (
    ((0.19, 0.37), (0.06, 0.33), (-0.08, 0.22)),
    ((0.08, 0.46), (-0.05, 0.39), (-0.20, 0.37)),
    ((0.18, 0.33), (0.06, 0.22), (0.02, 0.08)),
)


def hand_landmarks(
    wrist_m: tuple[float, float],
    direction_rad: float,
    *,
    thumb_right: bool,
    length_m: float = HAND_LENGTH_M,
    spread: float = 1.0,
) -> FloatArray:
    """Where a hand's landmarks are, shape (21, 2): x_m and z_m on the figure's sheet.

    Args:
        wrist_m: Place of the wrist.
        direction_rad: Of the middle finger, from straight up toward the right.
        thumb_right: The thumb lies to the right when the fingers point up.
        length_m: From the wrist to the middle finger's tip.
        spread: Of the fingers: 1 is wide apart, 0 is closed.
    """
    return place(_spread_landmarks(spread), wrist_m, direction_rad, thumb_right, length_m)


def paint_hand(
    canvas: Canvas,
    wrist_m: tuple[float, float],
    direction_rad: float,
    skin: Color,
    *,
    thumb_right: bool,
    palm_visible: bool,
    length_m: float = HAND_LENGTH_M,
    spread: float = 1.0,
) -> None:
    """Paint an open hand.

    Args:
        canvas: Painted on.
        wrist_m: Place of the wrist, x_m and z_m.
        direction_rad: Of the middle finger, from straight up toward the right.
        skin: Its color.
        thumb_right: The thumb lies to the right when the fingers point up.
        palm_visible: The palm's creases are seen; else the nails.
        length_m: From the wrist to the middle finger's tip.
        spread: Of the fingers: 1 is wide apart, 0 is closed.
    """
    landmarks = _spread_landmarks(spread)

    def discs(points: FloatArray, radii: tuple[float, ...]) -> list[Disc]:
        placed = place(points, wrist_m, direction_rad, thumb_right, length_m)
        return [
            (float(x), float(z), r * length_m) for (x, z), r in zip(placed, radii, strict=True)
        ]

    def stroke(points: FloatArray, width: float, color: Color) -> None:
        placed = place(points, wrist_m, direction_rad, thumb_right, length_m)
        canvas.line([(float(x), float(z)) for x, z in placed], color, width * length_m)

    blue, green, red = skin
    dark = (int(blue * 0.62), int(green * 0.66), int(red * 0.76))
    nail = tuple(int(channel + 0.45 * (245 - channel)) for channel in skin)
    chains = [(landmarks[list(rows)], _FINGER_RADII) for rows in _FINGERS]
    thumb = (landmarks[1:5], _THUMB_RADII)
    for points, radii in [*chains, thumb]:
        chain = discs(points, radii)
        hulls = [chain[row : row + 2] for row in range(len(chain) - 1)]
        canvas.paint(hulls, skin, radii[2] * length_m)
    palm = np.array(PALM)
    canvas.paint([discs(palm[:, :2], tuple(palm[:, 2]))], skin, 0.07 * length_m)
    ball = discs(np.array([(0.07, 0.10), (0.15, 0.26)]), (0.07, 0.06))  # of the thumb
    if palm_visible:
        canvas.paint([ball], skin, 0.06 * length_m, flat=0.4)
        for crease in _CREASES:
            stroke(np.array(crease), 0.014, dark)
    for points, radii in [*chains, thumb]:
        along = points[-1] - points[-2]
        along = along / np.linalg.norm(along)
        across = np.array([along[1], -along[0]])
        if palm_visible:
            for joint, radius in zip(points[1:3], radii[1:3], strict=True):
                stroke(
                    np.array([joint - 0.7 * radius * across, joint + 0.7 * radius * across]),
                    0.010, dark,
                )  # fmt: skip
        else:
            ends = np.array([points[-1] - 0.02 * along, points[-1] + 0.012 * along])
            canvas.paint([discs(ends, (0.024, 0.022))], (nail[0], nail[1], nail[2]), 0.002)


def place(
    points: FloatArray,
    wrist_m: tuple[float, float],
    direction_rad: float,
    thumb_right: bool,
    length_m: float,
) -> FloatArray:
    """Points of the hand's own axes (right and up, in hand lengths) on the sheet, in meters."""
    sign = 1.0 if thumb_right else -1.0
    right, up = points[:, 0] * sign * length_m, points[:, 1] * length_m
    cosine, sine = np.cos(direction_rad), np.sin(direction_rad)
    return np.stack(
        [wrist_m[0] + cosine * right + sine * up, wrist_m[1] - sine * right + cosine * up], axis=-1
    )


def _spread_landmarks(spread: float) -> FloatArray:
    """`LANDMARKS` with fingers and thumb turned about their roots, toward the middle finger."""
    if spread == 1.0:
        return LANDMARKS
    landmarks: FloatArray = LANDMARKS.copy()
    for root, *others in (*_FINGERS, (1, 2, 3, 4)):
        chain = LANDMARKS[others] - LANDMARKS[root]
        turn = (1.0 - spread) * np.arctan2(chain[-1, 0], chain[-1, 1])
        turn *= 0.7 if root == 1 else 1.0  # a thumb stays somewhat apart
        cosine, sine = np.cos(turn), np.sin(turn)
        landmarks[others] = LANDMARKS[root] + chain @ np.array([[cosine, sine], [-sine, cosine]])
    return landmarks
