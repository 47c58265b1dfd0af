"""How do floor and walls look from here? The background of the picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from tracker.containers import FloatArray, ImageArray
from tracker.simulation.interior import Wall
from tracker.simulation.projection import Viewpoint, clip_to_front
from tracker.simulation.rendering.poster import POSTER_PX_PER_M, paint_poster
from tracker.simulation.scene import Scene

_FLOOR_PX_PER_M = 48.0
_WALL_PX_PER_M = 96.0
_WALL_MAX_PX = 4096.0
_TILE_M = 0.5
_PANEL_M = 0.9
_CEILING = (226, 232, 234)
_FAR_M = 30.0


class RoomPainter:
    """Paints the empty room; its textures are made once.

    Args:
        scene: Whose room.
    """

    def __init__(self, scene: Scene) -> None:
        corners = [corner for wall in scene.walls for corner in wall.corners_m]
        corners += [(table.x_m, table.y_m) for table in scene.tables] or [(0.0, 0.0)]
        self._low = np.min(corners, axis=0) - 2.0
        size = np.minimum(np.max(corners, axis=0) + 2.0 - self._low, _FAR_M)
        self._floor = _floor_texture(size, bgr(scene.floor))
        self._floor_color = bgr(scene.floor)
        # Each straight piece hangs its own pictures; the number of the piece picks them.
        pieces = [(wall, piece) for wall in scene.walls for piece in range(len(wall.segments))]
        self._walls: list[_WallFace] = []
        for number, (wall, piece) in enumerate(pieces):
            face = _wall_face(wall.segments[piece], wall, number)
            self._walls += [face, *_poster_faces(face, wall, piece)]
        self._last: tuple[Viewpoint, ImageArray] | None = None

    def paint(self, view: Viewpoint) -> ImageArray:
        """Ceiling, floor and walls, shape (height, width, 3), BGR."""
        if self._last is None or self._last[0] != view:  # a robot that stands sees the same again
            self._last = (view, self._paint(view))
        return np.array(self._last[1])

    def _paint(self, view: Viewpoint) -> ImageArray:
        camera = view.camera
        frame = np.empty((camera.height, camera.width, 3), np.uint8)
        frame[:] = _CEILING
        horizon = int(np.clip(camera.cy + 2.0, 0, camera.height))
        if horizon < camera.height:
            texture_to_map = np.array(
                [[1 / _FLOOR_PX_PER_M, 0, self._low[0]], [0, 1 / _FLOOR_PX_PER_M, self._low[1]],
                 [0, 0, 1]]
            )  # fmt: skip
            lower = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, -horizon], [0.0, 0.0, 1.0]])
            frame[horizon:] = cv2.warpPerspective(
                self._floor,
                lower @ view.pixels_from_floor() @ texture_to_map,
                (camera.width, camera.height - horizon),
                flags=cv2.INTER_LINEAR,
                borderValue=self._floor_color,
            )
        place = np.array([view.x_m, view.y_m])
        for face in sorted(self._walls, key=lambda face: -face.distance_m(place)):
            _paint_wall(frame, view, face)
        return frame


def fill(
    frame: ImageArray, corners: FloatArray, color: Sequence[float], *, smooth: bool = True
) -> None:
    """Fill a convex outline.

    Args:
        frame: Painted on.
        corners: Shape (N, 2): columns and rows.
        color: One number per channel.
        smooth: Soften the edge.
    """
    fixed = np.round(np.clip(corners, -20_000, 20_000) * 16).astype(np.int32)
    cv2.fillConvexPoly(frame, fixed, color, cv2.LINE_AA if smooth else cv2.LINE_8, 4)


def bgr(color: str) -> tuple[int, int, int]:
    """Blue, green, red of a scene file's color."""
    return int(color[5:7], 16), int(color[3:5], 16), int(color[1:3], 16)


@dataclass(frozen=True, slots=True, eq=False)
class _WallFace:
    """One straight piece of wall, or a poster on it."""

    ends: FloatArray  # shape (2, 2), in the map
    top_m: float
    texture: ImageArray
    px_per_m: float
    middle: FloatArray  # shape (2,), of the wall: what hangs on it is painted right after it
    bottom_m: float = 0.0

    def distance_m(self, place: FloatArray) -> float:
        return float(np.linalg.norm(self.middle - place))


def _paint_wall(frame: ImageArray, view: Viewpoint, face: _WallFace) -> None:
    ends, top_m = view.forward_left(face.ends), face.top_m
    visible = clip_to_front(ends, closed=False)
    if len(visible) < 2:
        return
    lower = view.pixels(visible, face.bottom_m)
    outline = np.concatenate([view.pixels(visible, top_m), lower[::-1]])
    first = max(int(np.floor(outline[:, 0].min())), 0)
    last = min(int(np.ceil(outline[:, 0].max())) + 1, view.camera.width)
    wall_from_texture = np.array(
        [[1 / face.px_per_m, 0, 0], [0, -1 / face.px_per_m, top_m], [0, 0, 1]]
    )
    top = max(int(np.floor(outline[:, 1].min())), 0)
    bottom = min(int(np.ceil(outline[:, 1].max())) + 1, view.camera.height)
    if last <= first or bottom <= top:
        return
    shift = np.array([[1.0, 0.0, -first], [0.0, 1.0, -top], [0.0, 0.0, 1.0]])
    homography = shift @ view.pixels_from_wall(*ends) @ wall_from_texture
    size = (last - first, bottom - top)
    seen = cv2.warpPerspective(
        face.texture, homography, size, flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
    )
    mask = np.zeros(frame.shape[:2], np.uint8)
    fill(mask, outline, (255,), smooth=False)
    cv2.copyTo(seen, mask[top:bottom, first:last], frame[top:bottom, first:last])


def _floor_texture(size_m: FloatArray, color: tuple[int, int, int]) -> ImageArray:
    columns, rows = (size_m * _FLOOR_PX_PER_M).astype(int)
    tile = int(_TILE_M * _FLOOR_PX_PER_M)
    number = np.arange(rows)[:, None] // tile * 7919 + np.arange(columns)[None] // tile * 104_729
    tint = 0.95 + 0.10 * ((number * 2_654_435_761 % 2**32) / 2**32)
    joint = (np.arange(rows)[:, None] % tile < 1) | (np.arange(columns)[None] % tile < 1)
    tint = np.where(joint, 0.84, tint)
    return np.asarray(np.clip(tint[..., None] * color, 0, 255), dtype=np.uint8)


def _wall_face(segment: tuple[float, float, float, float], wall: Wall, number: int) -> _WallFace:
    span = np.array(segment[2:]) - np.array(segment[:2])
    length, height = float(np.linalg.norm(span)), wall.height_m
    # Walls that look to different sides are lit differently.
    light = 0.93 + 0.07 * float(np.cos(2 * np.arctan2(span[1], span[0])))
    px_per_m = min(_WALL_PX_PER_M, _WALL_MAX_PX / max(length, height))
    rows, columns = max(int(height * px_per_m), 2), max(int(length * px_per_m), 2)
    texture = np.empty((rows, columns, 3), np.float32)
    texture[:] = bgr(wall.color)

    def rectangle(x: float, z: float, width: float, tall: float, color: tuple[int, ...]) -> None:
        left, top = int(x * px_per_m), int((height - z - tall) * px_per_m)
        right, bottom = int((x + width) * px_per_m), int((height - z) * px_per_m)
        texture[max(top, 0) : max(bottom, 0), max(left, 0) : max(right, 0)] = color

    if height > _PANEL_M + 0.5:
        panel = np.array(bgr(wall.panel))
        rectangle(0.0, 0.0, length, _PANEL_M, tuple(panel))
        for x in np.arange(0.0, length, 0.3):
            rectangle(float(x), 0.1, 0.014, _PANEL_M - 0.1, tuple(panel * 0.86))
        rectangle(0.0, _PANEL_M, length, 0.045, tuple(panel * 0.72))
        rectangle(0.0, 0.0, length, 0.1, tuple(panel * 0.72))
        rectangle(0.0, height - 0.08, length, 0.08, tuple(np.array(bgr(wall.color)) * 0.93))
    if wall.pictures and height > 2.0:
        palette = [(150, 138, 96), (92, 128, 166), (116, 148, 108), (104, 112, 150)]
        for index, x in enumerate(np.arange(0.7, length - 0.9, 1.7)):
            hue = palette[(number + index) % len(palette)]
            rectangle(float(x), 1.38, 0.62, 0.46, (58, 66, 78))
            rectangle(float(x) + 0.03, 1.41, 0.56, 0.40, (226, 232, 236))
            rectangle(float(x) + 0.09, 1.47, 0.44, 0.28, hue)
            rectangle(float(x) + 0.09, 1.47, 0.44, 0.11, tuple(int(v * 0.7) for v in hue))
    lit = np.clip(texture * light, 0, 255).astype(np.uint8)
    ends = np.reshape(segment, (2, 2))
    return _WallFace(ends, height, lit, px_per_m, ends.mean(axis=0))


def _poster_faces(face: _WallFace, wall: Wall, piece: int) -> list[_WallFace]:
    along = face.ends[1] - face.ends[0]
    along = along / np.linalg.norm(along)
    faces = []
    for poster in wall.posters:
        if poster.piece == piece:
            # From the far end to the near one: to be read from within a room whose corners go
            # counter-clockwise.
            from_first = poster.at_m + poster.width_m / 2 * np.array([[1.0], [-1.0]])
            faces.append(
                _WallFace(
                    face.ends[0] + from_first * along,
                    poster.z_m + poster.height_m / 2,
                    paint_poster(poster, bgr(poster.color)),
                    POSTER_PX_PER_M,
                    face.middle,
                    poster.z_m - poster.height_m / 2,
                )
            )
    return faces
