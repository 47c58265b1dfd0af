"""One picture of a recording: the room from above, and a time line below it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from tracker.containers import FloatArray
from tracker.evaluation.metrics.raised_hands.episode_report import EpisodeReport
from tracker.outputs import writing_into
from tracker.report.history.history import History
from tracker.report.palette import PAPER
from tracker.report.plots.floor_plan import draw_floor_plan
from tracker.report.plots.timeline import draw_timeline, lanes_of

_WIDTH_IN = 10.0
#: Room for the key beside the floor plan, and how large that is.
_KEY_IN, _LEAST_HIGH_IN, _MOST_HIGH_IN, _LEAST_WIDE_IN = 2.1, 3.4, 6.6, 4.5
_DOTS_PER_INCH = 160
#: Around a camera that knows directions alone so much is shown.
_FAN_M, _DIRECTIONS = 2.0, np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
_MARGIN_M = 0.5
_WALLS_WITHIN_M = 4.0


def draw_overview(
    history: History,
    path: str | Path,
    truth: EpisodeReport | None = None,
) -> None:
    """Draw a recording from above, in meters of the fixed frame, over its timeline.

    Args:
        history: What was collected while the recording streamed.
        path: The .png file, replaced if it exists.
        truth: A comparison with the truth, whose places become rings and whose hands hollow bars.

    Raises:
        RecordingError: The file cannot be written.
    """
    lanes = lanes_of(history, truth)
    low, high = _extent(history, truth)
    left, width = 0.065, 0.915
    most_wide, aspect = width * _WIDTH_IN - _KEY_IN, (high - low)[1] / (high - low)[0]
    room_high = float(np.clip(most_wide * aspect, _LEAST_HIGH_IN, _MOST_HIGH_IN))
    room_wide = float(np.clip(room_high / aspect, _LEAST_WIDE_IN, most_wide))
    low, high = _widen(low, high, room_wide / room_high)
    time_high = 0.2 + 0.46 * max(1, len(lanes))
    figure_high = room_high + time_high + 1.62
    figure = Figure(figsize=(_WIDTH_IN, figure_high), dpi=_DOTS_PER_INCH, facecolor=PAPER)
    at = (
        left, (time_high + 1.22) / figure_high, room_wide / _WIDTH_IN, room_high / figure_high,
    )  # fmt: skip
    room = figure.add_axes(at)
    time = figure.add_axes((left, 0.5 / figure_high, width, time_high / figure_high))
    shown = {lane.person.id for lane in lanes if lane.person}
    draw_floor_plan(room, history, shown, truth, (low, high))
    draw_timeline(time, history, lanes)
    path = Path(path)
    with writing_into(path.parent) as new:
        figure.savefig(new(path.name), format="png")


def _extent(history: History, truth: EpisodeReport | None) -> tuple[FloatArray, FloatArray]:
    """Corners of what is worth showing: people and camera, and the walls around them."""
    people = history.people.values()
    parts = [person.path.rows for person in people]
    parts.append(history.camera_path.rows[:, :2])
    if truth is not None and truth.episodes:
        parts.append(np.array([row.xy_m for row in truth.episodes]))
    fans = [hand for person in people for hand in person.hands if hand.mean_xy_m is None]
    parts += [(hand.camera_xy_m + _FAN_M * _DIRECTIONS) for hand in fans]
    actors = np.vstack([np.zeros((0, 2)), *parts])
    actors = actors[np.all(np.isfinite(actors), axis=-1)]
    if len(actors) == 0:
        actors = np.zeros((1, 2))
    low, high = actors.min(axis=0), actors.max(axis=0)
    points, _ = history.walls.hits
    near = np.all((points > low - _WALLS_WITHIN_M) & (points < high + _WALLS_WITHIN_M), axis=-1)
    if np.any(near):
        corners = np.quantile(points[near], [0.003, 0.997], axis=0)
        low, high = np.minimum(low, corners[0]), np.maximum(high, corners[1])
    low, high = low - _MARGIN_M, high + _MARGIN_M
    return low, high


def _widen(low: FloatArray, high: FloatArray, aspect: float) -> tuple[FloatArray, FloatArray]:
    """The same view, `aspect` times as wide as high."""
    width, height = high - low
    margin = np.maximum(0.0, [height * aspect - width, width / aspect - height]) / 2
    return low - margin, high + margin
