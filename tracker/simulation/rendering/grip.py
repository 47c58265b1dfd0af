"""What does a closed hand look like? A palm, what it holds, bent fingers; one may point up."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from tracker.containers import FloatArray
from tracker.simulation.rendering.canvas import Canvas, Color, Disc
from tracker.simulation.rendering.hand_shape import LANDMARKS, PALM, place

_CUP, _PHONE = (236, 238, 240), (44, 40, 38)
_ROOTS = (5, 9, 13, 17)


def paint_grip(
    canvas: Canvas,
    wrist_m: tuple[float, float],
    direction_rad: float,
    skin: Color,
    *,
    thumb_right: bool,
    length_m: float,
    holds: str | None = None,
    points: bool = False,
) -> None:
    """Paint a closed hand.

    Args:
        canvas: Painted on.
        wrist_m: Place of the wrist, x_m and z_m.
        direction_rad: From the wrist to the knuckles, from straight up toward the right.
        skin: Its color.
        thumb_right: The thumb lies to the right when the knuckles point up.
        length_m: Of the open hand.
        holds: `cup` or `phone`; None is a fist.
        points: The index finger is stretched.
    """

    def discs(points_hands: FloatArray, *radii: float) -> list[Disc]:
        placed = place(points_hands, wrist_m, direction_rad, thumb_right, length_m)
        return [
            (float(x), float(z), r * length_m) for (x, z), r in zip(placed, radii, strict=True)
        ]

    if holds == "cup":  # upright, whichever way the hand is turned
        ((x, z, _),) = discs(np.array([(0.02, 0.52)]), 0.0)
        canvas.paint([[(x, z - 0.06, 0.029), (x, z + 0.06, 0.040)]], _CUP, 0.03)
    elif holds == "phone":
        ends = np.array([(0.06, 0.20), (0.06, 0.86)])
        canvas.paint([discs(ends, 0.18, 0.18)], _PHONE, 0.01)
    palm = np.array(PALM)
    canvas.paint([discs(palm[:, :2], *palm[:, 2])], skin, 0.07 * length_m)
    if points:
        for start, end in pairwise(LANDMARKS[[5, 6, 7, 8]]):
            canvas.paint([discs(np.array([start, end]), 0.055, 0.05)], skin, 0.05 * length_m)
    for root in LANDMARKS[list(_ROOTS[points:])]:
        finger = root + np.array([(0.0, 0.12), (0.05, -0.06)])
        canvas.paint([discs(finger, 0.058, 0.052)], skin, 0.05 * length_m)
    thumb = np.array([(0.15, 0.12), (0.24, 0.34), (0.14, 0.50)])
    chain = discs(thumb, 0.08, 0.065, 0.05)
    canvas.paint([chain[:2], chain[1:]], skin, 0.05 * length_m)
