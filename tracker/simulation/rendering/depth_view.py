"""What does a depth camera see? The room with its people, as distances ahead.

As a stereo camera tells them: with noise of the disparity, in steps, with pixels that mix two
surfaces, and with holes.
"""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from tracker.containers import FloatArray
from tracker.simulation.interior import Table
from tracker.simulation.legs import table_posts
from tracker.simulation.motion import People
from tracker.simulation.projection import NEAR_M, Viewpoint, clip_to_front
from tracker.simulation.rendering.camera_view import CameraView, ShownFigure
from tracker.simulation.scene import Camera, Depth, Scene

_SLAB_M = 0.04
#: Chest and belly stand so far out of a figure's plane, over half that width; arms and hands so
#: far; knees and feet of who sits. Guesses from anthropometric tables.
_CHEST_M, _CHEST_HALF_M, _ARM_M, _KNEES_M, _THIGH_M = 0.12, 0.19, 0.04, 0.35, 0.13
_NOWHERE_M = 1000.0
#: Neighbors farther apart than this are two surfaces; of the pixels between them half tell of a
#: place in between, and a quarter of nothing (guesses from pictures of a RealSense D435).
_EDGE_M, _MIXED, _LOST = 0.1, 0.5, 0.25
#: Noise is alike over so many pixels, as that of block matching is; holes come as large.
_NOISE_PX, _HOLE_PX = 4, 8

_Depths = NDArray[np.float32]


def depth_camera(scene: Scene, depth: Depth) -> Camera:
    """Intrinsics of the depth camera's pictures."""
    if depth.registered:
        return scene.camera
    return scene.camera.model_copy(
        update={
            "width": depth.width,
            "height": depth.height,
            "fx": depth.f_px,
            "fy": depth.f_px,
            "cx": depth.width / 2,
            "cy": depth.height / 2,
        }
    )


class DepthView:
    """Renders the depth images of one scene.

    Args:
        scene: What is there, with a depth camera.
        painter: Knows how its people look.
        rng: Noise.
    """

    def __init__(self, scene: Scene, painter: CameraView, rng: np.random.Generator) -> None:
        assert scene.depth is not None, "the scene has a depth camera"
        self._scene, self._depth = scene, scene.depth
        self._painter, self._rng = painter, rng
        self._last: tuple[Viewpoint, _Depths] | None = None

    def render(self, view: Viewpoint, people: People) -> NDArray[Any]:
        """One depth image as `DepthImage.read` gives it, shape (height, width)."""
        ahead_m = self._room(view).copy()
        for figure in self._painter.figures(view, people):
            self._lay_over(ahead_m, figure)
        told_m = self._as_told(ahead_m, view.camera.fx)
        if self._depth.unit == "mm":
            return np.round(np.nan_to_num(told_m) * 1000.0).astype(np.uint16)
        return told_m

    def _room(self, view: Viewpoint) -> _Depths:
        """Floor, walls and tables; a robot that stands sees the same again."""
        if self._last is not None and self._last[0] == view:
            return self._last[1]
        camera = view.camera
        down = (np.arange(camera.height) - camera.cy) / camera.fy
        floor_m = np.where(down > 0.0, view.z_m / np.maximum(down, 1e-6), _NOWHERE_M)
        ahead_m = np.empty((camera.height, camera.width), np.float32)
        ahead_m[:] = np.minimum(floor_m, _NOWHERE_M)[:, None]
        for wall in self._scene.walls:
            for segment in wall.segments:
                ends = np.reshape(segment, (2, 2))
                _stand_up(ahead_m, view, ends, 0.0, wall.height_m)
        for table in self._scene.tables:
            _put_table(ahead_m, view, table)
        self._last = (view, ahead_m)
        return ahead_m

    def _lay_over(self, ahead_m: _Depths, figure: ShownFigure) -> None:
        rows_columns = figure.pyramid.placed(
            (ahead_m.shape[0], ahead_m.shape[1]), figure.anchor_px, figure.px_per_m
        )
        if rows_columns is None:
            return
        window, bgra = rows_columns
        rows, columns = window
        x_m = (np.arange(columns.start, columns.stop) - figure.anchor_px[0]) / figure.px_per_m
        z_m = (figure.anchor_px[1] - np.arange(rows.start, rows.stop)) / figure.px_per_m
        round_m = np.sqrt(np.maximum(1.0 - (x_m / _CHEST_HALF_M) ** 2, 0.0)) * _CHEST_M
        out_m = np.broadcast_to(np.maximum(round_m, _ARM_M), (len(z_m), len(x_m)))
        seat_m = self._scene.people[figure.row].seat_m
        if seat_m is not None:
            out_m = np.where((z_m < seat_m + _THIGH_M)[:, None], _KNEES_M, out_m)
        surface_m = (figure.ahead_m - out_m).astype(np.float32)
        under = ahead_m[window]
        np.copyto(under, np.minimum(under, surface_m), where=bgra[..., 3] > 127)

    def _as_told(self, ahead_m: _Depths, f_px: float) -> _Depths:
        """What the camera makes of it, NaN for no reading."""
        depth, rng = self._depth, self._rng
        height, width = ahead_m.shape
        near_m, far_m = cv2.erode(ahead_m, np.ones((3, 3))), cv2.dilate(ahead_m, np.ones((3, 3)))
        rows, columns = np.nonzero(far_m - near_m > _EDGE_M)
        told_m: _Depths = ahead_m.copy()
        chance, share = rng.random((2, len(rows)), dtype=np.float32)
        near_m = near_m[rows, columns]
        between_m = near_m + share * (np.minimum(far_m[rows, columns], 10.0) - near_m)
        told_m[rows, columns] = np.where(chance < _MIXED, between_m, told_m[rows, columns])
        coarse = (height // _NOISE_PX + 1, width // _NOISE_PX + 1)
        blocks = rng.normal(0.0, depth.disparity_std_px, coarse).astype(np.float32)
        noise = cv2.resize(blocks, (width, height), interpolation=cv2.INTER_LINEAR)
        disparity = f_px * depth.baseline_m / told_m + noise
        step = np.float32(depth.disparity_step_px)
        disparity = np.maximum(np.round(disparity / step), 1.0) * step
        told_m = (f_px * depth.baseline_m / disparity).astype(np.float32)
        is_hole = rng.random((height // _HOLE_PX + 1, width // _HOLE_PX + 1)) < depth.holes
        is_hole = is_hole.repeat(_HOLE_PX, axis=0).repeat(_HOLE_PX, axis=1)[:height, :width]
        is_hole |= (ahead_m > depth.range_max_m) | (told_m < depth.range_min_m)
        told_m[is_hole | (told_m > 1.2 * depth.range_max_m)] = np.nan
        lost = chance > 1.0 - _LOST
        told_m[rows[lost], columns[lost]] = np.nan
        return told_m


def _put_table(ahead_m: _Depths, view: Viewpoint, table: Table) -> None:
    yaw = np.radians(table.yaw_deg)
    turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
    half = np.array([table.length_m, table.width_m]) / 2
    corners = np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]]) * half @ turn.T
    corners += np.array([table.x_m, table.y_m])
    for row in range(4):
        ends = corners[[row - 1, row]]
        _stand_up(ahead_m, view, ends, table.height_m - _SLAB_M, table.height_m)
    to_side = np.array([-np.sin(view.yaw_rad), np.cos(view.yaw_rad)])
    for x_m, y_m, radius_m in table_posts(table):
        ends = np.array([x_m, y_m]) + np.array([[1.0], [-1.0]]) * radius_m * to_side
        _stand_up(ahead_m, view, ends, 0.0, table.height_m)
    slab = clip_to_front(view.forward_left(corners), closed=True)
    if len(slab) < 3 or view.z_m <= table.height_m:
        return
    outline = view.pixels(slab, table.height_m)
    mask = np.zeros(ahead_m.shape, np.uint8)
    fixed = np.round(np.clip(outline, -20_000, 20_000) * 16).astype(np.int32)
    cv2.fillConvexPoly(mask, fixed, (1,), cv2.LINE_8, 4)
    camera = view.camera
    down = (np.arange(camera.height) - camera.cy) / camera.fy
    top_m = np.where(down > 0.0, (view.z_m - table.height_m) / np.maximum(down, 1e-6), _NOWHERE_M)
    top = np.broadcast_to(top_m.astype(np.float32)[:, None], ahead_m.shape)
    np.copyto(ahead_m, np.minimum(ahead_m, top), where=mask > 0)


def _stand_up(
    ahead_m: _Depths, view: Viewpoint, ends_m: FloatArray, low_m: float, high_m: float
) -> None:
    """Put something flat and upright into the picture.

    Args:
        ahead_m: Changed in place.
        view: The camera.
        ends_m: Shape (2, 2): both ends in the map.
        low_m: From this height ...
        high_m: ... to this.
    """
    camera = view.camera
    ends = view.forward_left(ends_m)
    visible = clip_to_front(ends, closed=False)
    if len(visible) < 2:
        return
    edges = view.pixels(visible, 0.0)[:, 0]
    first = max(int(np.floor(edges.min())), 0)
    last = min(int(np.ceil(edges.max())) + 1, camera.width)
    if last <= first:
        return
    aside = (camera.cx - np.arange(first, last)) / camera.fx
    (begin_f, begin_l), (step_f, step_l) = ends[0], ends[1] - ends[0]
    across = step_l - aside * step_f
    across = np.where(np.abs(across) < 1e-9, 1e-9, across)
    share = np.clip((aside * begin_f - begin_l) / across, 0.0, 1.0)
    there_m = np.maximum(begin_f + share * step_f, NEAR_M)
    up = (camera.cy - np.arange(camera.height)) / camera.fy
    z_m = view.z_m + up[:, None] * there_m
    part = ahead_m[:, first:last]
    is_it = (z_m >= low_m) & (z_m <= high_m) & (there_m < part)
    np.copyto(part, there_m.astype(np.float32), where=is_it)
