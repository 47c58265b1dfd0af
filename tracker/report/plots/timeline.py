"""Raised, exists, fresh, served: who was what when? One lane per person, truth above.

Existence is a curve over the height of the bar that says when the hand was up; a thin bar below
says when the estimate was fresh enough to drive to.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from tracker.containers import BoolArray, FloatArray
from tracker.evaluation.metrics.raised_hands.episode_report import EpisodeReport, EpisodeRow
from tracker.report.history.history import History, Person
from tracker.report.palette import FADED, INK, LIT, PAPER, person_color

_LANES = 20
_BAR = 0.36
_TRUTH_BAR = 0.13
_FRESH = "#4aa3a0"
#: A gesture is named that lasts for so much of the recording; less has no room for a word.
_WORD = 0.04


@dataclass(slots=True, eq=False)
class Lane:
    """What one line of the timeline shows.

    Attributes:
        person: The customer as tracked; None where the truth's person was never reported.
        truth: The truth's episodes that belong here.
    """

    person: Person | None
    truth: list[EpisodeRow] = field(default_factory=list)


def lanes_of(history: History, truth: EpisodeReport | None = None) -> list[Lane]:
    """Lanes in order of time; those who raised a hand first where there is no room for all.

    Args:
        history: What was collected while the recording streamed.
        truth: The comparison with the truth, whose episodes join the lane of their first identity.
    """
    people = sorted(history.people.values(), key=lambda person: (not person.hands, person.id))
    lanes = {person.id: Lane(person) for person in people[:_LANES]}
    missed: dict[int, Lane] = {}
    for row in truth.episodes if truth is not None else ():
        known = truth.identities.get(row.person, ()) if truth is not None else ()
        home = next((lanes[key] for key in (*row.identities, *known) if key in lanes), None)
        if home is None and len(missed) < _LANES:
            home = missed.setdefault(row.person, Lane(None))
        if home is not None:
            home.truth.append(row)
    return [*sorted(lanes.values(), key=_first_ns), *missed.values()]


def draw_timeline(axes: Axes, history: History, lanes: list[Lane]) -> None:
    """Draw the lanes from top to bottom over seconds (minutes, hours) since the start.

    Args:
        axes: Where to draw.
        history: What was collected while the recording streamed.
        lanes: From `lanes_of`.
    """
    end_ns = max([history.end_ns or 0, *(row.end_ns for lane in lanes for row in lane.truth)])
    end_s = max(history.seconds(end_ns), 1e-3) if history.end_ns is not None else 1.0
    per_unit, unit = next(
        (size, name) for size, name in _UNITS if end_s < 90 * size or size == 3600
    )
    for row, lane in enumerate(lanes):
        _draw_lane(axes, history, lane, -float(row), end_ns, per_unit)
    axes.set_facecolor(PAPER)
    axes.set_xlim(0.0, end_s / per_unit)
    axes.set_ylim(-max(1, len(lanes)) + 0.45, 0.6)
    axes.set_yticks(
        [-row for row in range(len(lanes))], [_name(lane) for lane in lanes], fontsize=10
    )
    for label, lane in zip(axes.get_yticklabels(), lanes, strict=True):
        label.set_color(person_color(lane.person.id) if lane.person else FADED)
        label.set_fontweight("bold")
    axes.tick_params(axis="x", colors=FADED, labelsize=8, length=0)
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel(f"time since the start ({unit})", color=FADED, fontsize=9, labelpad=2)
    axes.grid(axis="x", color="#ecebe6", lw=0.6)
    axes.set_axisbelow(True)
    for spine in axes.spines.values():
        spine.set_visible(False)
    if not lanes:
        axes.text(
            0.5, 0.5, "nobody raised a hand", transform=axes.transAxes, ha="center", va="center",
            color=FADED, fontsize=10,
        )  # fmt: skip
    _draw_legend(axes, history, lanes)


_UNITS = ((1, "s"), (60, "min"), (3600, "h"))


def _draw_lane(
    axes: Axes, history: History, lane: Lane, y: float, end_ns: int, per_unit: float
) -> None:
    def place(start_ns: int, stop_ns: int | None) -> tuple[float, float]:
        start = history.seconds(start_ns) / per_unit
        return start, history.seconds(end_ns if stop_ns is None else stop_ns) / per_unit - start

    for row in lane.truth:
        axes.broken_barh(
            [place(row.start_ns, row.end_ns)], (y + _BAR / 2 + 0.1, _TRUTH_BAR),
            facecolors="none", edgecolors=INK, linewidths=0.9, zorder=4,
        )  # fmt: skip
    person = lane.person
    if person is None:
        return
    color = person_color(person.id)
    began, confirmed = (
        place(stamp, stamp)[0] for stamp in (person.first_seen_ns, person.confirmed_ns)
    )
    axes.plot([began, confirmed], [y, y], color=color, lw=1.4, ls=(0, (1, 1.2)), zorder=3)
    at_s, existence, is_fresh = person.states.rows.T
    low = y - _BAR / 2
    exists = low + _BAR * existence
    axes.fill_between(at_s / per_unit, low, exists, color=color, alpha=0.15, lw=0, zorder=1)
    axes.plot(at_s / per_unit, exists, color=INK, lw=0.9, alpha=0.8, zorder=5.5)
    axes.broken_barh(
        _runs(at_s / per_unit, is_fresh > 0.5), (low - 0.13, 0.08), facecolors=_FRESH,
        linewidths=0, zorder=4,
    )  # fmt: skip
    axes.broken_barh(
        [place(span.start_ns, span.end_ns) for span in person.selected],
        (y - _BAR / 2 - 0.05, _BAR + 0.1), facecolors=LIT, alpha=0.75, linewidths=0, zorder=2,
    )  # fmt: skip
    axes.broken_barh(
        [place(hand.start_ns, hand.end_ns) for hand in person.hands],
        (y - _BAR / 2, _BAR), facecolors=color, linewidths=0, zorder=5,
    )  # fmt: skip
    _, whole = place(history.start_ns or 0, end_ns)
    for span in person.said:
        start, length = place(span.start_ns, span.end_ns)
        if length >= _WORD * whole:
            axes.text(
                start, y, f" {span.gesture.label}", ha="left", va="center_baseline", color=INK,
                fontsize=7, clip_on=True, zorder=6,
            )  # fmt: skip


def _runs(at: FloatArray, is_on: BoolArray) -> list[tuple[float, float]]:
    """Starts and lengths of the times in which something held, from row to row."""
    edges = np.flatnonzero(np.diff(np.r_[False, is_on, False].astype(int)))
    stops = np.minimum(edges[1::2], len(at) - 1)
    return [(float(at[a]), float(at[b] - at[a])) for a, b in zip(edges[::2], stops, strict=True)]


def _draw_legend(axes: Axes, history: History, lanes: list[Lane]) -> None:
    handles: list[Patch | Line2D] = [
        Line2D([], [], color=FADED, lw=1.4, ls=(0, (1, 1.2)), label="seen, has not called yet"),
        Line2D([], [], color=INK, lw=0.9, alpha=0.8, label="exists (0 to 1)"),
        Patch(fc=FADED, ec="none", label="hand up"),
        Patch(fc=_FRESH, ec="none", label="fresh"),
        Patch(fc=LIT, ec="none", alpha=0.75, label="served"),
    ]
    if any(lane.truth for lane in lanes):
        handles.append(Patch(fc="none", ec=INK, lw=0.9, label="really up"))
    legend = axes.legend(
        handles=handles, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=len(handles),
        frameon=False, fontsize=8, labelcolor=INK, handlelength=1.6, columnspacing=1.4,
        borderaxespad=0.0, handleheight=0.7,
    )  # fmt: skip
    legend.set_zorder(6)
    hidden = sum(1 for person in history.people.values()) - sum(1 for lane in lanes if lane.person)
    hidden += history.people_dropped
    if hidden > 0:
        axes.text(
            0.0, 1.0, f"and {hidden} more people", transform=axes.transAxes, ha="left",
            va="bottom", color=FADED, fontsize=8,
        )  # fmt: skip


def _name(lane: Lane) -> str:
    return f"#{lane.person.id}" if lane.person else "missed"


def _first_ns(lane: Lane) -> float:
    person = lane.person
    if person is None:
        return np.inf
    return person.hands[0].start_ns if person.hands else np.inf
