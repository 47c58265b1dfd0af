"""What does the room look like from above at this moment? A quick picture beside the camera's."""

from __future__ import annotations

from functools import lru_cache

import cv2
import numpy as np

from tracker.containers import FloatArray, FrameResult, ImageArray, SensorKind, Tracks
from tracker.geometry import worst_std
from tracker.report.fan import PLACED_STD_M, fan
from tracker.report.palette import FADED, INK, LIT, PAPER, ROBOT, WALL, as_bgr, person_color

#: Camera of the specification: 640 columns at a focal length of 460.
FIELD_OF_VIEW_RAD = 2 * float(np.arctan(320 / 460))

_SIDE_PX = 480
_SHIFT = 4  # fractional bits of OpenCV's drawing coordinates
_ROBOT_AT = 0.84  # of the height, from the top: most of what matters is ahead
_SIGMAS_95 = 2.448  # square root of chi-square's 95 % quantile for two dimensions
_FAN_OF_HEIGHT = 0.62  # reach of a direction, of the picture's height
_UNSEEN = (236, 238, 238)
_RING = (222, 224, 224)
_FONT = cv2.FONT_HERSHEY_SIMPLEX


def draw_birdseye(
    result: FrameResult,
    *,
    ahead_m: float = 4.0,
) -> ImageArray:
    """Draw one image's result from above, the camera at the bottom looking up.

    Left in the camera's picture is left here. Without a transform the camera is supposed to stand
    at the origin of the fixed frame.

    Args:
        result: What the pipeline made of the image.
        ahead_m: How far the picture reaches in front of the camera.

    Returns:
        Shape (480, 480, 3), uint8, blue-green-red.
    """
    width = height = _SIDE_PX
    camera = result.sensor_pose if result.sensor_pose is not None else np.zeros(3)
    view = _View(width, height, camera, ahead_m)
    picture: ImageArray = _empty_room(width, height, ahead_m).copy()
    if result.scan is not None:
        view.draw_scan(picture, result.scan.returns_m(3 * ahead_m))
    view.draw_rays(picture, result)
    view.draw_camera(picture)
    view.draw_people(picture, result)
    return picture


@lru_cache(maxsize=8)
def _empty_room(width: int, height: int, ahead_m: float) -> ImageArray:
    """What never changes: the field of view, and a ring for every meter."""
    origin, scale, far = _origin(width, height), _scale(height, ahead_m), 2.0 * (width + height)
    picture = np.empty((height, width, 3), np.uint8)
    picture[:] = _UNSEEN
    sides = np.linspace(-0.5, 0.5, 33) * FIELD_OF_VIEW_RAD
    edge = origin + far * np.stack([np.sin(sides), -np.cos(sides)], axis=-1)
    corners = np.round(np.vstack([origin, edge])).astype(np.int32)
    cv2.fillPoly(picture, [corners], as_bgr(PAPER), cv2.LINE_AA)
    for meters in range(1, 2 + int(np.hypot(width, height) / scale)):
        radius = round(meters * scale * (1 << _SHIFT))
        cv2.circle(picture, _fixed_point(origin), radius, _RING, 1, cv2.LINE_AA, _SHIFT)
        at = (int(origin[0]) + 4, int(origin[1] - meters * scale) - 4)
        _text(picture, f"{meters} m", at, FADED, 0.36)
    picture.flags.writeable = False
    return picture


class _View:
    """Where points of the fixed frame fall in the picture, and how things are drawn there."""

    def __init__(self, width: int, height: int, camera: FloatArray, ahead_m: float) -> None:
        self._size = np.array([width, height])
        self._scale = _scale(height, ahead_m)
        self._origin = _origin(width, height)
        self._camera = camera
        cos, sin = np.cos(camera[2]), np.sin(camera[2])
        # Right in the picture is minus the camera's y axis, down is minus its x axis.
        self._picture_from_fixed = np.array([[sin, -cos], [-cos, -sin]]) * self._scale

    def pixels(self, points: FloatArray) -> FloatArray:
        offset = (points - self._camera[:2]) @ self._picture_from_fixed.T
        return np.asarray(offset + self._origin, dtype=np.float64)

    def draw_scan(self, picture: ImageArray, points: FloatArray) -> None:
        cells = np.round(self.pixels(points)).astype(np.int64)
        inside = np.all((cells >= 1) & (cells < self._size - 1), axis=-1)
        columns, rows = cells[inside].T
        for right, down in ((0, 0), (1, 0), (0, 1), (1, 1)):
            picture[rows + down, columns + right] = as_bgr(WALL)

    def draw_rays(self, picture: ImageArray, result: FrameResult) -> None:
        claims = result.measurements
        has_bearing = np.isin(claims.kind, (SensorKind.BEARING_RANGE, SensorKind.BEARING))
        for row in np.flatnonzero(claims.raised & has_bearing):
            x, y, yaw = claims.sensor_pose[row]
            bearing, range_m = claims.values[row]
            length = range_m if np.isfinite(range_m) else 2 * float(self._size.max()) / self._scale
            heading = yaw + bearing
            ends = np.array([[x, y], [x + length * np.cos(heading), y + length * np.sin(heading)]])
            start, end = self.pixels(ends)
            _line(picture, start, end, as_bgr(LIT))

    def draw_camera(self, picture: ImageArray) -> None:
        outline = self._origin + np.array([[0, -13], [9, 8], [0, 4], [-9, 8]])
        corners = np.round(outline * (1 << _SHIFT)).astype(np.int32)
        cv2.fillPoly(picture, [corners], as_bgr(ROBOT), cv2.LINE_AA, _SHIFT)

    def draw_people(self, picture: ImageArray, result: FrameResult) -> None:
        tracks = result.tracks
        if len(tracks) == 0:
            return
        is_placed = worst_std(tracks.covariance[:, :2, :2]) <= PLACED_STD_M
        for row in np.flatnonzero(~is_placed & tracks.confirmed):
            self._draw_fan(picture, tracks, int(row))
        tracks = tracks[is_placed | ~tracks.confirmed]
        centers = self.pixels(tracks.mean[:, :2])
        turn = self._picture_from_fixed
        covariances = turn @ tracks.covariance[:, :2, :2] @ turn.T
        limit = 4.0 * float(self._size.max())  # OpenCV's coordinates would overflow far outside
        for row in np.flatnonzero(np.all(np.abs(centers) < limit, axis=-1)):
            track_id, center = int(tracks.id[row]), centers[row]
            color = as_bgr(person_color(track_id) if tracks.confirmed[row] else FADED)
            at, is_selected = _fixed_point(center), track_id == tracks.selected_id
            if is_selected:
                cv2.circle(picture, at, 22 << _SHIFT, as_bgr(LIT), 4, cv2.LINE_AA, _SHIFT)
            _ellipse(picture, center, np.minimum(covariances[row], limit**2), color)
            filled = -1 if tracks.raised[row] else 2
            cv2.circle(picture, at, 9 << _SHIFT, color, filled, cv2.LINE_AA, _SHIFT)
            self._name(picture, tracks, int(row), center)

    def _draw_fan(self, picture: ImageArray, tracks: Tracks, row: int) -> None:
        """Somebody of whom the direction alone is known."""
        right_rad, left_rad = fan(
            tracks.mean[row, :2], tracks.covariance[row, :2, :2], self._camera[:2]
        )
        # A narrow fan is a pair of edges; a wide one needs points between them.
        sides = np.linspace(right_rad, left_rad, 9)
        reach_m = _FAN_OF_HEIGHT * float(self._size[1]) / self._scale
        rim = self._camera[:2] + reach_m * np.stack([np.cos(sides), np.sin(sides)], axis=-1)
        corners = self.pixels(np.vstack([self._camera[:2], rim]))
        points = np.round(corners * (1 << _SHIFT)).astype(np.int32)
        tinted = picture.copy()
        color = as_bgr(person_color(int(tracks.id[row])))
        cv2.fillPoly(tinted, [points], color, cv2.LINE_AA, _SHIFT)
        cv2.addWeighted(tinted, 0.3, picture, 0.7, 0.0, dst=picture)
        cv2.polylines(picture, [points], True, color, 1, cv2.LINE_AA, _SHIFT)
        self._name(picture, tracks, row, corners[len(corners) // 2])

    def _name(self, picture: ImageArray, tracks: Tracks, row: int, at: FloatArray) -> None:
        track_id = int(tracks.id[row])
        is_up, is_selected = bool(tracks.raised[row]), track_id == tracks.selected_id
        parts = [f"#{track_id}", "HAND UP" if is_up else "", "SERVED" if is_selected else ""]
        words = " ".join(filter(None, parts))
        length = cv2.getTextSize(words, _FONT, 0.5, 1)[0][0]
        left = min(int(at[0]) + 16, int(self._size[0]) - length - 6)
        _text(picture, words, (max(4, left), max(14, int(at[1]) - 16)), INK, 0.5)


def _ellipse(
    picture: ImageArray, center: FloatArray, covariance: FloatArray, color: tuple[int, int, int]
) -> None:
    values, vectors = np.linalg.eigh(covariance)
    axes = _SIGMAS_95 * np.sqrt(np.maximum(values, 0.0)) * (1 << _SHIFT)
    angle = float(np.degrees(np.arctan2(vectors[1, 0], vectors[0, 0])))
    sides = (round(float(axes[0])), round(float(axes[1])))
    cv2.ellipse(picture, _fixed_point(center), sides, angle, 0, 360, color, 1, cv2.LINE_AA, _SHIFT)


def _line(
    picture: ImageArray, start: FloatArray, end: FloatArray, color: tuple[int, int, int]
) -> None:
    cv2.line(picture, _fixed_point(start), _fixed_point(end), color, 1, cv2.LINE_AA, _SHIFT)


def _text(picture: ImageArray, words: str, at: tuple[int, int], color: str, size: float) -> None:
    cv2.putText(picture, words, at, _FONT, size, as_bgr(PAPER), 3, cv2.LINE_AA)
    cv2.putText(picture, words, at, _FONT, size, as_bgr(color), 1, cv2.LINE_AA)


def _scale(height: int, ahead_m: float) -> float:
    return height * _ROBOT_AT / ahead_m  # pixels per meter


def _origin(width: int, height: int) -> FloatArray:
    return np.array([width / 2, height * _ROBOT_AT])


def _fixed_point(point: FloatArray) -> tuple[int, int]:
    return round(float(point[0]) * (1 << _SHIFT)), round(float(point[1]) * (1 << _SHIFT))
