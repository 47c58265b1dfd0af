"""The state of the page: the newest frame, drawn only when a browser asks for it.

The thread that processes frames leaves a reference here and goes on; it never draws, and never
waits for a browser.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import cv2
import numpy as np

from tracker.config import Config
from tracker.containers import CameraImage, FrameResult
from tracker.dashboard.health import Health
from tracker.dashboard.map_picture import MapPicture
from tracker.dashboard.memory import Memory
from tracker.dashboard.parameters import changed, live_parameters
from tracker.errors import TrackerError
from tracker.geometry import worst_std
from tracker.report.fan import PLACED_STD_M, fan
from tracker.report.video.debug_picture import draw_debug_image
from tracker.service import Answer, Command

#: Pictures for the page are at most so wide, and a scan has so many points.
_WIDTH_PX, _POINTS = 800, 400
_JPEG_QUALITY = 80


class Steering(Protocol):
    """What executes the page's buttons and sliders."""

    def obey(self, command: Command) -> Answer:
        """Follow a command about the waiting list."""

    def configure(self, config: Config) -> None:
        """Change parameters while running."""


@dataclass(frozen=True, slots=True)
class Shown:
    """A frame as a browser gets it.

    Attributes:
        number: Counts the frames.
        state: JSON's kinds of values.
        jpeg: The camera's picture with what was found in it.
    """

    number: int
    state: dict[str, Any]
    jpeg: bytes


class Dashboard:
    """A watcher of frames that browsers look at.

    Args:
        config: The parameters in force.
        title: What is watched, for the page's head.
        steering: Follows buttons and sliders, between two frames; None shows a page without.
    """

    def __init__(self, config: Config, title: str, steering: Steering | None = None) -> None:
        self.title, self.steering = title, steering
        self._config = config
        self._lock = threading.Lock()
        self._latest: tuple[CameraImage, FrameResult] | None = None
        self._number = 0
        self._memory, self._health = Memory(), Health()
        self._map: MapPicture | None = None
        self._orders: deque[Callable[[], None]] = deque()
        self._said: deque[str] = deque(maxlen=5)
        self._shown: Shown | None = None
        self._drawing = threading.Lock()

    @property
    def number(self) -> int:
        """Of the newest frame."""
        return self._number

    def watch(self, image: CameraImage, result: FrameResult, busy_s: float) -> None:
        """Take in one frame, in the thread that processes them; follow orders of the page."""
        with self._lock:
            self._latest = image, result
            self._memory.add(result)
            self._health.add(result, busy_s)
            self._number += 1
            if result.room_map is not None:
                before = self._map or MapPicture(1, result.room_map.grid)
                self._map = before.after(result.room_map)
        self.follow_orders()

    def follow(self, config: Config) -> None:
        """Take over parameters that were changed elsewhere."""
        self._config = config

    def follow_orders(self) -> None:
        """Do what the page has asked for, in the thread that processes frames."""
        while self._orders:
            self._orders.popleft()()

    def ask(self, request: dict[str, Any]) -> None:
        """Take a request of the page: {"do": "serve 3"} or {"set": [name, value]}.

        It is followed before the next frame; what comes of it is among `said`.
        """
        steering = self.steering
        if steering is None:
            self._said.append("this page is read-only; nothing can be changed here")
            return
        if "do" in request:
            self._orders.append(lambda: self._obey(steering, str(request["do"])))
        elif isinstance(request.get("set"), list) and len(request["set"]) == 2:
            name, value = request["set"]
            self._orders.append(lambda: self._change(steering, str(name), value))

    def parameters(self) -> list[dict[str, Any]]:
        """What the page shows as sliders."""
        return live_parameters(self._config) if self.steering is not None else []

    def show(self) -> Shown | None:
        """The newest frame, drawn once for all browsers; None before the first one."""
        with self._drawing:
            with self._lock:
                if self._latest is None:
                    return None
                (image, result), number = self._latest, self._number
                if self._shown is not None and self._shown.number == number:
                    return self._shown
                past = self._memory.timeline()
                trails = {one: self._memory.trail(one) for one in result.tracks.id.tolist()}
                health, room_map = self._health.lines(), self._map
            state = _state(result, trails) | {
                "timeline": past,
                "health": health,
                "said": list(self._said),
                "frame": number,
            }
            if result.room_map is not None and room_map is not None:
                state["map"] = room_map.place(result.room_map)
            self._shown = Shown(number, state, self._draw(image, result))
            return self._shown

    def map_png(self) -> bytes | None:
        """The picture of the newest map; None without one."""
        newest = self._map
        return None if newest is None else newest.png()

    def _draw(self, image: CameraImage, result: FrameResult) -> bytes:
        factor = max(1, -(-image.width // _WIDTH_PX))
        config = self._config.model_copy(update={"downscale_factor": factor})
        picture = draw_debug_image(image, result.hands, result.tracks, config)
        _, jpeg = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, _JPEG_QUALITY])
        return jpeg.tobytes()

    def _obey(self, steering: Steering, text: str) -> None:
        try:
            answer = steering.obey(Command.parse(text))
        except TrackerError as error:
            answer = Answer(False, str(error))
        self._said.append(answer.text)

    def _change(self, steering: Steering, name: str, value: object) -> None:
        try:
            config = changed(self._config, name, value)
        except TrackerError as error:
            self._said.append(str(error))
            return
        self._config = config
        steering.configure(config)
        self._said.append(f"{name} is {value}")


def _state(result: FrameResult, trails: dict[int, list[tuple[float, float]]]) -> dict[str, Any]:
    """A frame in JSON's kinds of values; meters, radians and seconds."""
    tracks = result.tracks[result.tracks.confirmed]
    calls = result.waiting_list
    people: list[dict[str, Any]] = []
    for row, track_id in enumerate(tracks.id.tolist()):
        covariance = tracks.covariance[row, :2, :2]
        people.append(
            {
                "id": track_id,
                "x": round(float(tracks.mean[row, 0]), 3),
                "y": round(float(tracks.mean[row, 1]), 3),
                "ellipse": _ellipse(covariance),
                "std": round(float(worst_std(covariance)), 2),
                "up": bool(tracks.raised[row]),
                "selected": track_id == tracks.selected_id,
                "trail": trails.get(track_id, []),
            }
        )
        if worst_std(covariance) > PLACED_STD_M and result.sensor_pose is not None:
            sides = fan(tracks.mean[row, :2], covariance, result.sensor_pose[:2])
            people[-1]["fan"] = [round(side, 3) for side in sides]
    callers = [
        {
            "id": caller.id,
            "state": caller.state.value,
            "called_s": round((calls.stamp_ns - caller.called_ns) / 1e9, 1),
            "unseen_s": round((calls.stamp_ns - caller.seen_ns) / 1e9, 1),
            "in_sight": caller.track_id is not None,
            "track": caller.track_id,
            "up": caller.is_up,
            "x": round(caller.xy_m[0], 2),
            "y": round(caller.xy_m[1], 2),
            "selected": caller.id == calls.selected_id,
        }
        for caller in calls.callers
    ]
    return {
        "stamp_s": result.stamp_ns / 1e9,
        "hand_raised": result.hand_raised,
        "robot": None if result.sensor_pose is None else result.sensor_pose.round(3).tolist(),
        "people": people,
        "callers": callers,
        "scan": _scan_points(result),
    }


def _ellipse(covariance: np.ndarray) -> list[float]:
    """Half axes in m and the first one's direction in rad of the 95 % ellipse."""
    variances, directions = np.linalg.eigh(covariance)
    axes = np.sqrt(np.maximum(variances[::-1], 0.0) * 5.991)
    angle = float(np.arctan2(directions[1, 1], directions[0, 1]))
    return [round(float(axes[0]), 3), round(float(axes[1]), 3), round(angle, 3)]


def _scan_points(result: FrameResult) -> list[list[float]]:
    if result.scan is None:
        return []
    points = result.scan.xy_m[np.isfinite(result.scan.xy_m).all(axis=1)]
    step = max(1, -(-len(points) // _POINTS))
    thinned: list[list[float]] = points[::step].round(2).tolist()
    return thinned
