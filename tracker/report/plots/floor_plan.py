"""Who raised a hand where? A recording's room from above, people and camera on their paths."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb, to_rgba
from matplotlib.lines import Line2D
from matplotlib.markers import MarkerStyle
from matplotlib.patches import Ellipse, Patch, Wedge
from matplotlib.path import Path as Outline
from matplotlib.patheffects import withStroke
from matplotlib.transforms import ScaledTranslation

from tracker.containers import FloatArray
from tracker.evaluation.metrics.raised_hands.episode_report import EpisodeReport
from tracker.report.history.history import History, Person, RaisedHand
from tracker.report.palette import FADED, INK, LIT, PAPER, ROBOT, WALL, person_color
from tracker.report.plots.hand_icon import HAND
from tracker.report.video.birdseye import FIELD_OF_VIEW_RAD

_SIGMAS_95 = 2.448  # square root of chi-square's 95 % quantile for two dimensions
_GLANCES = 14  # fields of view drawn over each other, so that often-seen places shine brighter
_HANDS_DRAWN = 50  # per person, the latest
_STEM_IN = 0.27
#: From the place at the origin up to the disc, which hides the upper edge; of height 1.
_TAIL = Outline([(0.0, 0.0), (0.27, 1.0), (-0.27, 1.0), (0.0, 0.0)], closed=True)
_HALO = [withStroke(linewidth=3.0, foreground=PAPER)]


def draw_floor_plan(
    axes: Axes,
    history: History,
    shown: Collection[int],
    truth: EpisodeReport | None,
    corners_m: tuple[FloatArray, FloatArray],
) -> None:
    """Draw the room from above, in meters of the fixed frame.

    Args:
        axes: Where to draw; already of the shape of the view.
        history: What was collected while the recording streamed.
        shown: Ids of people whose hands and names are drawn; of others there is the path.
        truth: A comparison with the truth, whose places become rings.
        corners_m: Lower left and upper right of the view, shape (2,) each.
    """
    low, high = corners_m
    axes.set_facecolor(PAPER)
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal")
    size_m = float(np.min(high - low))
    _draw_camera(axes, history, 0.55 * size_m)
    _draw_walls(axes, history)
    if truth is not None and truth.episodes:
        x, y = np.array([row.xy_m for row in truth.episodes]).T
        axes.scatter(x, y, s=100, c="none", edgecolors=INK, lw=1.3, zorder=12)
    _draw_paths(axes, history.people.values(), shown)
    for track_id in sorted(shown):
        _draw_person(axes, history.people[track_id], 0.06 * size_m)
    has_walls = len(history.walls.hits[0]) > 0
    _draw_key(axes, history.people.values(), truth, has_walls=has_walls)
    axes.set_title(
        "Who raised a hand, and where", loc="left", fontsize=13, color=INK, weight="bold", pad=8
    )
    axes.set_xlabel("x (m)", color=FADED, fontsize=9, labelpad=2)
    axes.set_ylabel("y (m)", color=FADED, fontsize=9)
    axes.tick_params(colors=FADED, labelsize=8, length=0)
    axes.grid(color="#ecebe6", lw=0.6, zorder=0)
    axes.set_axisbelow(True)
    for spine in axes.spines.values():
        spine.set_visible(False)


def _draw_walls(axes: Axes, history: History) -> None:
    points, counts = history.walls.hits
    if len(points) == 0:
        return
    # Walls are hit by most scans that see them, passing people by few: let those fade.
    share = np.clip(counts / max(1.0, float(np.quantile(counts, 0.9))), 0.0, 1.0)
    kept = counts > min(2.0, 0.02 * float(counts.max()))
    colors = np.tile((*to_rgb(WALL), 0.0), (int(kept.sum()), 1))
    colors[:, 3] = 0.06 + 0.74 * share[kept]
    left, right = axes.get_xlim()
    width_points = axes.bbox.width * 72 / axes.figure.dpi
    side = max(1.2, 1.08 * history.walls.cell_m * width_points / (right - left))
    axes.scatter(
        points[kept, 0], points[kept, 1], s=side**2, c=colors, marker="s", linewidths=0, zorder=2
    )


def _draw_camera(axes: Axes, history: History, reach_m: float) -> None:
    path = history.camera_path.rows
    if len(path) == 0:
        return
    half_deg = float(np.degrees(FIELD_OF_VIEW_RAD)) / 2

    def field_of_view(row: FloatArray, **style: Any) -> None:
        x, y, heading = float(row[0]), float(row[1]), float(np.degrees(row[2]))
        sides = (heading - half_deg, heading + half_deg)
        axes.add_patch(Wedge((x, y), reach_m, *sides, **style))

    for row in np.linspace(0, len(path) - 1, min(len(path), _GLANCES)).astype(int):
        field_of_view(path[row], fc=LIT, ec="none", alpha=0.022, zorder=1)
    field_of_view(path[-1], fc="none", ec=FADED, lw=0.8, ls=(0, (4, 3)), alpha=0.8, zorder=3)
    axes.plot(path[:, 0], path[:, 1], color=ROBOT, lw=1.6, alpha=0.55, zorder=4)
    x, y, yaw = path[-1].tolist()
    nose = MarkerStyle("^").rotated(rad=yaw - np.pi / 2)
    axes.scatter(x, y, s=190, marker=nose, c=ROBOT, linewidths=0, zorder=6)
    axes.annotate(
        "camera", (x, y), xytext=(0, -17), textcoords="offset points", ha="center", fontsize=8,
        color=ROBOT, path_effects=_HALO, zorder=9,
    )  # fmt: skip


def _draw_paths(axes: Axes, people: Collection[Person], shown: Collection[int]) -> None:
    colors = [to_rgba(person_color(item.id), 0.55 if item.id in shown else 0.2) for item in people]
    paths = [person.path.rows for person in people]
    axes.add_collection(LineCollection(paths, colors=colors, linewidths=1.4, zorder=5))


def _draw_person(axes: Axes, person: Person, apart_m: float) -> None:
    color = person_color(person.id)
    pinned: list[FloatArray] = []
    for hand in person.hands[-_HANDS_DRAWN:]:
        if hand.mean_xy_m is None:
            _draw_fan(axes, hand, person)
            continue
        _draw_place(axes, hand, color)
        if all(np.linalg.norm(hand.xy_m - other) > apart_m for other in pinned):
            pinned.append(hand.xy_m)
            _draw_pin(axes, hand.xy_m, color, is_lit=_was_selected(person, hand))
    if not pinned and not len(person.path.rows):
        return
    x, y = (pinned[0] if pinned else person.path.rows[-1]).tolist()
    if not pinned:
        axes.scatter(x, y, s=26, c=PAPER, edgecolors=color, linewidths=1.4, zorder=7)
    axes.annotate(
        f"#{person.id}", (x, y), xytext=(15, 23 if pinned else 8), textcoords="offset points",
        fontsize=11, weight="bold", color=color, path_effects=_HALO, zorder=12,
    )  # fmt: skip


def _draw_place(axes: Axes, hand: RaisedHand, color: str) -> None:
    values, vectors = np.linalg.eigh(hand.covariance_m2)
    width, height = 2 * _SIGMAS_95 * np.sqrt(np.maximum(values, 0.0))
    angle = float(np.degrees(np.arctan2(vectors[1, 0], vectors[0, 0])))
    x, y = hand.xy_m.tolist()
    filled, outlined = {"fc": color, "ec": "none", "alpha": 0.13}, {"fc": "none", "ec": color}
    styles: tuple[dict[str, Any], ...] = (filled, outlined)
    for style in styles:
        axes.add_patch(Ellipse((x, y), width, height, angle=angle, lw=1.1, zorder=6, **style))
    axes.scatter(x, y, s=16, c=color, linewidths=0, zorder=8)


def _draw_fan(axes: Axes, hand: RaisedHand, person: Person) -> None:
    """A raised hand of which only the bearing is known: two standard deviations to each side."""
    color, (x, y) = person_color(person.id), hand.camera_xy_m.tolist()
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    reach_m = 0.45 * min(right - left, top - bottom)
    sides = np.degrees(hand.fan_rad)
    axes.add_patch(Wedge((x, y), reach_m, *sides, fc=color, ec="none", alpha=0.2, zorder=6))
    middle_rad = np.radians(sides.mean())
    along = reach_m * np.array([np.cos(middle_rad), np.sin(middle_rad)])
    axes.annotate(
        f"#{person.id}", (x + along[0], y + along[1]), ha="center", va="center", fontsize=11,
        weight="bold", color=color, path_effects=_HALO, zorder=12,
    )  # fmt: skip


def _draw_pin(axes: Axes, xy_m: FloatArray, color: str, *, is_lit: bool) -> None:
    """A raised hand on a pin whose tip stands at the place, so that the place stays visible."""
    x, y = xy_m.tolist()
    up = ScaledTranslation(0.0, _STEM_IN, axes.figure.dpi_scale_trans)
    above = axes.transData + up
    for size, alpha in ((1700, 0.10), (1200, 0.14), (800, 0.24), (500, 1.0)) if is_lit else ():
        axes.scatter(x, y, s=size, c=LIT, alpha=alpha, linewidths=0, zorder=10, transform=above)
    axes.scatter(
        x, y, s=(2 * 72 * _STEM_IN) ** 2, marker=_TAIL, c=color, edgecolors=PAPER,
        linewidths=0.8, zorder=10.5,
    )  # fmt: skip
    axes.scatter(
        x, y, s=330, c=color, edgecolors=PAPER, linewidths=1.3, zorder=11, transform=above
    )
    axes.scatter(x, y, s=165, marker=HAND, c=PAPER, linewidths=0, zorder=11.5, transform=above)


def _draw_key(
    axes: Axes, people: Collection[Person], truth: EpisodeReport | None, *, has_walls: bool
) -> None:
    def dot(label: str, **style: Any) -> Line2D:
        return Line2D([], [], ls="none", label=label, **style)

    hands = [hand for person in people for hand in person.hands]
    handles: list[Line2D | Patch] = []
    if any(hand.mean_xy_m is not None for hand in hands):
        handles += [
            dot("a raised hand: the pin\nstands at the place", marker=HAND, mfc=FADED, mec="none",
                ms=13),
            dot("lit: the customer who\nis served", marker="o", mfc=LIT, mec="none", ms=12),
            dot("inside with 95 %\nprobability", marker="o", mfc="#e3e5e7", mec=FADED, ms=12),
        ]  # fmt: skip
    if any(hand.mean_xy_m is None for hand in hands):
        fan = Outline([(-1.0, 0.0), (1.0, 0.45), (1.0, -0.45), (-1.0, 0.0)], closed=True)
        handles.append(
            dot("a hand raised in this\ndirection: how far away\nis unknown", marker=fan,
                mfc="#b9c3c9", mec="none", ms=16)
        )  # fmt: skip
    handles += [
        dot("the camera, at the end", marker="^", mfc=ROBOT, mec="none", ms=9),
        Line2D([], [], color=FADED, lw=0.9, ls=(0, (4, 3)), label="what it sees at the end"),
        Patch(fc="#fbf3da", ec="none", label="what it has seen"),
    ]
    if has_walls:
        handles.append(dot("hit by the laser scan", marker="s", mfc=WALL, mec="none", ms=4))
    if truth is not None:
        handles.append(dot("where the person really\nwas", marker="o", mfc="none", mec=INK, ms=8))
    key = axes.legend(
        handles=handles, loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=8.5,
        labelcolor=INK, frameon=False, labelspacing=0.9, borderaxespad=0.0,
    )  # fmt: skip
    key.set_zorder(20)


def _was_selected(person: Person, hand: RaisedHand) -> bool:
    last = np.inf
    return any(
        span.start_ns < (hand.end_ns or last) and hand.start_ns < (span.end_ns or last)
        for span in person.selected
    )
