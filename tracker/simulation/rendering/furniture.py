"""How does furniture look from here? Tables with plates, chairs, bar stools: boards and posts."""

from __future__ import annotations

import cv2
import numpy as np

from tracker.containers import FloatArray, ImageArray
from tracker.simulation.interior import Chair, Table
from tracker.simulation.legs import CHAIR_HALF_M, chair_legs, in_map, table_posts
from tracker.simulation.projection import Viewpoint, clip_to_front
from tracker.simulation.rendering.room import bgr, fill

_SLAB_M = 0.04
_CLOSE_M = 0.2  # posts and plates nearer than this are left out
_PLATE_RIMS = ((0.12, (222, 226, 228)), (0.075, (240, 242, 243)))  # radius_m, color
#: The feet of pedestals and of bar stools, and half the width of those of two posts.
_PEDESTAL_FOOT_M, _STOOL_FOOT_M, _POST_FOOT_M, _FOOT_HEIGHT_M = 0.22, 0.20, 0.05, 0.03
_STOOL_SEAT_M = 0.18
#: The back of a chair is a board between these heights above the seat.
_BACK_M = (0.12, 0.45)
_RIM = np.linspace(0.0, 2 * np.pi, 32, endpoint=False)
_CIRCLE = np.stack([np.cos(_RIM), np.sin(_RIM)], axis=-1)
_CORNERS = np.array([[1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]])

_Color = tuple[float, ...]


class TablePainter:
    """Paints one table; its outlines in the map are worked out once.

    Args:
        table: Which.
        exposure: Brightness of its colors.
    """

    def __init__(self, table: Table, exposure: float = 1.0) -> None:
        self._height_m = table.height_m
        color = np.array(bgr(table.color), np.float64) * exposure
        self._dark = tuple(color * 0.55)
        self._posts = table_posts(table)
        half_size = np.array([table.length_m, table.width_m]) / 2
        outline = (_CIRCLE if table.round else _CORNERS) * half_size
        self._slab = _Board(in_map(table, outline), table.height_m, color)
        self._feet = [_Board(foot, _FOOT_HEIGHT_M, 0.6 * color) for foot in _feet(table)]
        angles = 2 * np.pi * np.arange(table.plates) / max(table.plates, 1)
        seats = np.stack([np.cos(angles), np.sin(angles)], axis=-1) * (half_size - 0.17)
        self._plates = [
            (in_map(table, seats[:, None] + radius * _CIRCLE), tuple(exposure * np.array(color)))
            for radius, color in _PLATE_RIMS
        ]

    def paint(self, frame: ImageArray, view: Viewpoint) -> None:
        """Lay the table over the picture."""
        if not self._slab.is_in_picture(view):
            return
        for foot in self._feet:
            foot.paint(frame, view)
        _paint_posts(frame, view, self._posts, self._height_m, self._dark)
        self._slab.paint(frame, view)
        if view.z_m <= self._height_m:
            return  # its top is not seen from below
        for circles, color in self._plates:
            places = view.forward_left(circles)
            for place in places[(places[..., 0] > _CLOSE_M).all(axis=1)]:
                fill(frame, view.pixels(place, self._height_m), color)


class ChairPainter:
    """Paints one chair or bar stool: first what its sitter hides, then its back.

    Args:
        chair: Which.
        exposure: Brightness of its colors.

    Attributes:
        xy_m: Shape (2,): its middle in the map.
        back_xy_m: Shape (2,): the middle of its back; None for a bar stool.
    """

    def __init__(self, chair: Chair, exposure: float = 1.0) -> None:
        color = np.array(bgr(chair.color), np.float64) * exposure
        self._dark = tuple(color * 0.6)
        self._color = tuple(color * 0.85)
        self._seat_m = chair.seat_m
        self._legs = chair_legs(chair)
        half_m = CHAIR_HALF_M + 0.02
        is_chair = chair.kind == "chair"
        seat = half_m * _CORNERS if is_chair else _STOOL_SEAT_M * _CIRCLE
        self._seat = _Board(in_map(chair, seat), chair.seat_m, color)
        foot = in_map(chair, _STOOL_FOOT_M * _CIRCLE)
        self._feet = [] if is_chair else [_Board(foot, _FOOT_HEIGHT_M, 0.6 * color)]
        self._back = in_map(chair, np.array([[-half_m, -half_m], [-half_m, half_m]]))
        self.xy_m = np.array([chair.x_m, chair.y_m])
        self.back_xy_m = self._back.mean(axis=0) if is_chair else None

    def paint_seat(self, frame: ImageArray, view: Viewpoint) -> None:
        """Lay legs and seat over the picture."""
        if not self._seat.is_in_picture(view):
            return
        for foot in self._feet:
            foot.paint(frame, view)
        _paint_posts(frame, view, self._legs, self._seat_m, self._dark)
        self._seat.paint(frame, view)

    def paint_back(self, frame: ImageArray, view: Viewpoint) -> None:
        """Lay the back of a chair over the picture."""
        ends = clip_to_front(view.forward_left(self._back), closed=False)
        if len(ends) < 2:
            return
        low_m, high_m = (self._seat_m + above_m for above_m in _BACK_M)
        posts = np.column_stack([self._back, np.full(2, 0.015)])
        _paint_posts(frame, view, posts, high_m, self._dark, self._seat_m)
        board = np.concatenate([view.pixels(ends, high_m), view.pixels(ends, low_m)[::-1]])
        fill(frame, board, self._color)


class _Board:
    """A level board: its rim, and its top where that is seen from above."""

    def __init__(self, outline_m: FloatArray, top_m: float, color: FloatArray) -> None:
        self._outline_m, self._top_m = outline_m, top_m
        self._top_color, self._rim_color = tuple(color), tuple(color * 0.72)

    def is_in_picture(self, view: Viewpoint) -> bool:
        top = self._top_px(view)
        return len(top) >= 3 and top[:, 0].max() >= 0 and top[:, 0].min() <= view.camera.width

    def paint(self, frame: ImageArray, view: Viewpoint) -> None:
        ahead_left = clip_to_front(view.forward_left(self._outline_m), closed=True)
        if len(ahead_left) < 3:
            return
        top = view.pixels(ahead_left, self._top_m)
        below = view.pixels(ahead_left, max(self._top_m - _SLAB_M, 0.0))
        hull = cv2.convexHull(np.concatenate([top, below]).astype(np.float32))[:, 0]
        fill(frame, np.asarray(hull, np.float64), self._rim_color)
        if view.z_m > self._top_m:
            fill(frame, top, self._top_color)

    def _top_px(self, view: Viewpoint) -> FloatArray:
        ahead_left = clip_to_front(view.forward_left(self._outline_m), closed=True)
        return view.pixels(ahead_left, self._top_m)


def _feet(table: Table) -> list[FloatArray]:
    """Outlines in the map of what one or two posts stand on; four legs need nothing."""
    posts = table_posts(table)[:, :2]
    if table.posts == 1:
        return [in_map(table, _PEDESTAL_FOOT_M * _CIRCLE)]
    if table.posts == 2:
        half_size = np.array([_POST_FOOT_M, table.width_m / 2 - 0.1])
        bar = in_map(table, half_size * _CORNERS) - (table.x_m, table.y_m)
        return [post + bar for post in posts]
    return []


def _paint_posts(
    frame: ImageArray,
    view: Viewpoint,
    posts: FloatArray,
    top_m: float,
    color: _Color,
    bottom_m: float = 0.0,
) -> None:
    """Upright round bars, shape (P, 3): x_m, y_m, radius_m in the map."""
    places = view.forward_left(posts[:, :2])
    ahead = places[:, 0] > _CLOSE_M
    posts, places = posts[ahead], places[ahead]
    columns, tops = view.pixels(places, top_m).T
    bottoms = view.pixels(places, bottom_m)[:, 1]
    halves = posts[:, 2] * view.camera.fx / places[:, 0]
    for u, top, bottom, half in zip(columns, tops, bottoms, halves, strict=True):
        corners = [(u - half, top), (u + half, top), (u + half, bottom), (u - half, bottom)]
        fill(frame, np.array(corners), color)
