"""Where did everybody walk, and how certain was it? Trails with their ellipses, from above."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from tracker.containers import FloatArray
from tracker.report.history.history import History
from tracker.report.history.states import PersonStates, States
from tracker.report.palette import FADED, INK, PAPER, ROBOT, WALL, person_color

_ELLIPSES = 12  # along each trail
_SIGMAS = 2.0
_MARGIN_M = 0.7
_WALLS_WITHIN_M = 4.0


def draw_trail_map(history: History, states: States) -> Figure:
    """Draw every confirmed customer's trail with 2-sigma ellipses, in meters of the fixed frame.

    Args:
        history: The walls and the camera's path.
        states: The people.
    """
    low, high = _extent(history, states)
    wide, tall = np.maximum(high - low, 1.0)
    figure = Figure(
        figsize=(6.6, float(np.clip(5.9 * tall / wide, 3.0, 6.6)) + 0.9),
        facecolor=PAPER,
        layout="constrained",
    )
    axes = figure.add_subplot()
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xlabel="x (m)", ylabel="y (m)")
    axes.set_aspect("equal", adjustable="box")
    axes.set_facecolor(PAPER)
    points, counts = history.walls.hits
    if len(points):
        seen = counts > min(2.0, 0.02 * float(counts.max()))  # passing people fade
        axes.plot(*points[seen].T, ".", color=WALL, ms=1.4, alpha=0.5, zorder=1)
    camera = history.camera_path.rows
    axes.plot(camera[:, 0], camera[:, 1], color=ROBOT, lw=1.4, ls=(0, (3, 1.5)), zorder=2)
    axes.plot(*camera[-1:, :2].T, "^", color=ROBOT, ms=9, zorder=5)
    for person in states.people.values():
        _draw_person(axes, person)
    _draw_key(figure)
    axes.grid(color="#ecebe6", lw=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(colors=INK, labelsize=9, length=0)
    axes.spines[:].set_visible(False)
    return figure


def _draw_person(axes: Axes, person: PersonStates) -> None:
    color, xy = person_color(person.id), person.xy_m
    axes.plot(*xy.T, color=color, lw=1.5, alpha=0.8, zorder=4)
    chosen = np.unique(np.linspace(0, len(xy) - 1, _ELLIPSES).round().astype(int))
    values, vectors = np.linalg.eigh(person.covariance_m2[chosen])
    widths, heights = 2 * _SIGMAS * np.sqrt(np.maximum(values, 0.0)).T
    axes.add_collection(
        EllipseCollection(
            widths, heights, np.degrees(np.arctan2(vectors[:, 1, 0], vectors[:, 0, 0])),
            units="xy", offsets=xy[chosen], offset_transform=axes.transData,
            facecolors="none", edgecolors=color, linewidths=0.8, alpha=0.6, zorder=3,
        )
    )  # fmt: skip
    axes.plot(*xy[0], "o", mfc=PAPER, mec=color, ms=5, zorder=5)
    axes.plot(*xy[-1], "o", color=color, ms=6, zorder=5)
    axes.annotate(
        f"#{person.id}", xy[-1], xytext=(7, 5), textcoords="offset points", color=color,
        fontsize=11, weight="bold", zorder=6,
    )  # fmt: skip


def _draw_key(figure: Figure) -> None:
    def dot(label: str, **style: object) -> Line2D:
        return Line2D([], [], ls="none", label=label, marker="o", mec=FADED, **style)  # type: ignore[arg-type]

    handles = [
        Line2D([], [], color=FADED, lw=1.5, label="trail"),
        dot("first place", mfc=PAPER, ms=5),
        dot("last place", mfc=FADED, ms=6),
        dot("2 sigma", mfc="none", ms=11, mew=0.8),
        Line2D([], [], color=ROBOT, lw=1.4, ls=(0, (3, 1.5)), marker="^", ms=6, label="camera"),
        Line2D([], [], color=WALL, ls="none", marker=".", ms=4, label="laser"),
    ]
    figure.legend(
        handles=handles, loc="outside upper center", ncols=6, frameon=False, fontsize=9,
        labelcolor=INK, handlelength=1.4, columnspacing=1.2, handletextpad=0.5,
    )  # fmt: skip


def _extent(history: History, states: States) -> tuple[FloatArray, FloatArray]:
    """Corners of where people and the camera went, and of the walls close by."""
    parts = [person.xy_m for person in states.people.values()]
    actors = np.vstack([np.zeros((0, 2)), *parts, history.camera_path.rows[:, :2]])
    actors = actors[np.isfinite(actors).all(axis=-1)]
    if len(actors) == 0:
        actors = np.zeros((1, 2))
    low, high = actors.min(axis=0), actors.max(axis=0)
    points, _ = history.walls.hits
    near = ((points > low - _WALLS_WITHIN_M) & (points < high + _WALLS_WITHIN_M)).all(axis=-1)
    if near.any():
        low, high = (
            np.minimum(low, points[near].min(axis=0)),
            np.maximum(high, points[near].max(axis=0)),
        )
    return low - _MARGIN_M, high + _MARGIN_M
