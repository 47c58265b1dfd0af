"""How does a table look from here? Posts, a slab, plates on it."""

from __future__ import annotations

import cv2
import numpy as np

from tracker.containers import FloatArray, ImageArray
from tracker.simulation.lidar import table_posts
from tracker.simulation.projection import Viewpoint, clip_to_front
from tracker.simulation.room import bgr, fill
from tracker.simulation.scene import Table

_SLAB_M = 0.04
_CLOSE_M = 0.2  # posts and plates nearer than this are left out
_PLATE_RIMS = ((0.12, (222, 226, 228)), (0.075, (240, 242, 243)))  # radius_m, color
_RIM = np.linspace(0.0, 2 * np.pi, 32, endpoint=False)


class TablePainter:
    """Paints one table; its outlines in the map are worked out once.

    Args:
        table: Which.
        exposure: Brightness of its colors.
    """

    def __init__(self, table: Table, exposure: float = 1.0) -> None:
        self._height_m = table.height_m
        color = np.array(bgr(table.color), np.float64) * exposure
        self._top, self._rim, self._dark = (tuple(color * light) for light in (1.0, 0.72, 0.55))
        self._posts = table_posts(table)
        half_size = np.array([table.length_m, table.width_m]) / 2
        corners = np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]]) * half_size
        self._slab = _in_map(table, corners)
        angles = 2 * np.pi * np.arange(table.plates) / max(table.plates, 1)
        seats = np.stack([np.cos(angles), np.sin(angles)], axis=-1) * (half_size - 0.17)
        circle = np.stack([np.cos(_RIM), np.sin(_RIM)], axis=-1)
        self._plates = [
            (_in_map(table, seats[:, None] + radius * circle), tuple(exposure * np.array(color)))
            for radius, color in _PLATE_RIMS
        ]

    def paint(self, frame: ImageArray, view: Viewpoint) -> None:
        """Lay the table over the picture."""
        slab = clip_to_front(view.forward_left(self._slab), closed=True)
        if len(slab) < 3:
            return
        top = view.pixels(slab, self._height_m)
        if top[:, 0].max() < 0 or top[:, 0].min() > view.camera.width:
            return
        self._paint_posts(frame, view)
        rim = np.concatenate([top, view.pixels(slab, self._height_m - _SLAB_M)])
        hull = cv2.convexHull(rim.astype(np.float32))[:, 0]
        fill(frame, np.asarray(hull, np.float64), self._rim)
        if view.z_m <= self._height_m:
            return  # its top is not seen from below
        fill(frame, top, self._top)
        for circles, color in self._plates:
            places = view.forward_left(circles)
            for place in places[(places[..., 0] > _CLOSE_M).all(axis=1)]:
                fill(frame, view.pixels(place, self._height_m), color)

    def _paint_posts(self, frame: ImageArray, view: Viewpoint) -> None:
        places = view.forward_left(self._posts[:, :2])
        ahead = places[:, 0] > _CLOSE_M
        posts, places = self._posts[ahead], places[ahead]
        columns, tops = view.pixels(places, self._height_m).T
        bottoms = view.pixels(places, 0.0)[:, 1]
        halves = posts[:, 2] * view.camera.fx / places[:, 0]
        for u, top, bottom, half in zip(columns, tops, bottoms, halves, strict=True):
            corners = [(u - half, top), (u + half, top), (u + half, bottom), (u - half, bottom)]
            fill(frame, np.array(corners), self._dark)


def _in_map(table: Table, own: FloatArray) -> FloatArray:
    """Points of the table's own axes, shape (..., 2), in the map."""
    yaw = np.radians(table.yaw_deg)
    turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
    return np.asarray(own @ turn.T + (table.x_m, table.y_m))
