"""How does a flat silhouette look round? Shaded shapes on a transparent sheet.

Every shape is a union of convex hulls of discs: two discs make a limb, three in a row a finger,
four a trunk. The distance to the silhouette's edge serves as height, its slope as surface normal.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

from tracker.containers import ImageArray

#: x_m (to the right), z_m (up), radius_m.
Disc = tuple[float, float, float]
Color = tuple[int, int, int]  # blue, green, red

_LIGHT = np.array([-0.38, -0.55, 0.74])  # from the upper left, toward the viewer
_CIRCLE = np.stack(
    [np.cos(np.linspace(0, 2 * np.pi, 48)), np.sin(np.linspace(0, 2 * np.pi, 48))], axis=-1
)
_SUBPIXEL_BITS = 4


@dataclass(frozen=True, slots=True, eq=False)
class Sprite:
    """A picture to be scaled and laid over another one.

    Attributes:
        bgra: Shape (height, width, 4), uint8; the colors are already multiplied by the opacity.
        anchor_px: Column and row of the point x = 0, z = 0 (between the feet).
        px_per_m: Resolution.
    """

    bgra: ImageArray
    anchor_px: tuple[float, float]
    px_per_m: float


class Canvas:
    """A transparent sheet that stands upright; x to the right and z up, in meters.

    Args:
        half_width_m: It reaches from minus this to this.
        height_m: It reaches from 0.05 m below the floor to this.
        px_per_m: Resolution.
    """

    def __init__(self, half_width_m: float, height_m: float, px_per_m: float) -> None:
        self.px_per_m = px_per_m
        self._origin = np.array([half_width_m, height_m])
        rows, columns = int((height_m + 0.05) * px_per_m), int(2 * half_width_m * px_per_m)
        self._color = np.zeros((rows, columns, 3), np.float32)
        self._opacity = np.zeros((rows, columns), np.float32)

    def copy(self) -> Canvas:
        """The same sheet to be painted on separately."""
        twin = object.__new__(Canvas)
        twin.px_per_m, twin._origin = self.px_per_m, self._origin
        twin._color, twin._opacity = self._color.copy(), self._opacity.copy()
        return twin

    def paint(
        self,
        hulls: Sequence[Sequence[Disc]],
        color: Color,
        roundness_m: float,
        *,
        flat: float = 0.0,
    ) -> None:
        """Lay one shaded shape over what is there.

        Args:
            hulls: Each is the convex hull of its discs; the shape is their union.
            color: Of a surface that faces the viewer.
            roundness_m: Width of the curved rim; a limb's radius makes it a cylinder.
            flat: 0 shades fully, 1 not at all.
        """
        outlines = [self._outline(hull) for hull in hulls]
        everything = np.concatenate(outlines)
        rows, columns = self._opacity.shape
        left, top = np.maximum(np.floor(everything.min(axis=0)).astype(int) - 3, 0)
        right, bottom = np.minimum(
            np.ceil(everything.max(axis=0)).astype(int) + 3, (columns, rows)
        )
        if right <= left or bottom <= top:
            return
        mask = np.zeros((bottom - top, right - left), np.uint8)
        for outline in outlines:
            corners = np.round((outline - (left, top)) * 2**_SUBPIXEL_BITS).astype(np.int32)
            cv2.fillConvexPoly(mask, corners, 255, cv2.LINE_AA, _SUBPIXEL_BITS)
        light = _lambert(mask, roundness_m * self.px_per_m)
        light = flat + (1.0 - flat) * light
        cover = mask.astype(np.float32) / 255.0
        inside = np.s_[top:bottom, left:right]
        shaded = np.minimum(light[..., None] * np.array(color, np.float32), 255.0)
        self._color[inside] += cover[..., None] * (shaded - self._color[inside])
        self._opacity[inside] += cover * (1.0 - self._opacity[inside])

    def line(self, points: Sequence[tuple[float, float]], color: Color, width_m: float) -> None:
        """A stroke along points (x_m, z_m), of one color."""
        half = width_m / 2
        self.paint(
            [[(*start, half), (*end, half)] for start, end in pairwise(points)],
            color,
            half,
            flat=1.0,
        )

    def sprite(self) -> Sprite:
        """What was painted, cut to its content."""
        painted = self._opacity > 0.0
        rows, columns = np.flatnonzero(painted.any(axis=1)), np.flatnonzero(painted.any(axis=0))
        top, bottom, left, right = rows[0], rows[-1] + 1, columns[0], columns[-1] + 1
        inside = np.s_[top:bottom, left:right]
        opacity = self._opacity[inside][..., None]
        bgra = np.concatenate([self._color[inside], opacity * 255.0], axis=-1)
        anchor = self._origin * self.px_per_m - (left, top)
        return Sprite(
            np.round(bgra).astype(np.uint8), (float(anchor[0]), float(anchor[1])), self.px_per_m
        )

    def _outline(self, hull: Sequence[Disc]) -> NDArray[np.float32]:
        rims = np.concatenate([_CIRCLE * radius + (x, z) for x, z, radius in hull])
        pixels = (rims - (0.0, self._origin[1])) * (1.0, -1.0) + (self._origin[0], 0.0)
        corners = cv2.convexHull((pixels * self.px_per_m).astype(np.float32))
        return np.asarray(corners[:, 0])


def _lambert(mask: ImageArray, rim_px: float) -> NDArray[np.float32]:
    rim_px = max(rim_px, 1.0)
    inside = (mask > 127).astype(np.uint8)
    distance = np.minimum(cv2.distanceTransform(inside, cv2.DIST_L2, 5) / rim_px, 1.0)
    height = np.sqrt(np.maximum(1.0 - (1.0 - distance) ** 2, 0.0)) * rim_px
    height = cv2.GaussianBlur(height, (0, 0), max(0.12 * rim_px, 0.8))
    slope_x = cv2.Sobel(height, cv2.CV_32F, 1, 0, ksize=3) / 8
    slope_y = cv2.Sobel(height, cv2.CV_32F, 0, 1, ksize=3) / 8
    length = np.sqrt(slope_x**2 + slope_y**2 + 1.0)
    cosine = (-slope_x * _LIGHT[0] - slope_y * _LIGHT[1] + _LIGHT[2]) / length
    # A surface that faces the viewer keeps its color; what turns away darkens to a bit over half.
    light: NDArray[np.float32] = 0.56 + 0.44 * np.clip(cosine / _LIGHT[2], 0.0, 1.25)
    return light.astype(np.float32)
