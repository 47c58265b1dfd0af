"""Raised, exists, fresh, served: each person's states over time, one lane per person."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from tracker.report.history.history import History, Person, Span
from tracker.report.history.states import PersonStates, States
from tracker.report.palette import FADED, INK, LIT, PAPER, person_color

_LANES = 20
_EXISTS_HIGH, _BAR_HIGH = 0.46, 0.11
_FRESH = "#4aa3a0"


def draw_state_timeline(history: History, states: States) -> Figure:
    """Draw a lane per confirmed customer, those who raised a hand first where there are many.

    Existence is a curve from 0 to 1 over the lane's upper half; below it are bars of when the hand
    was up, when the estimate was fresh enough to drive to, and when the person was served.

    Args:
        history: The intervals.
        states: Existence and freshness.
    """
    people = [person for person in history.people.values() if person.id in states.people]
    people = sorted(people, key=lambda person: (not person.hands, person.id))[:_LANES]
    people.sort(key=lambda person: person.first_seen_ns)
    high_in = 1.1 + 0.62 * max(1, len(people))
    figure = Figure(figsize=(6.6, high_in), facecolor=PAPER, layout="constrained")
    axes = figure.add_subplot()
    for row, person in enumerate(people):
        _draw_lane(axes, history, person, states.people[person.id], -float(row))
    axes.set_facecolor(PAPER)
    end_s = history.seconds(history.end_ns) if history.end_ns is not None else 0.0
    axes.set(xlim=(0.0, max(end_s, 1e-3)), ylim=(-max(1, len(people)) + 0.42, 0.6))
    axes.set_xlabel("time since the start (s)", color=INK)
    axes.set_yticks([-row for row in range(len(people))], [f"#{item.id}" for item in people])
    axes.tick_params(colors=INK, labelsize=9, length=0)
    for label, person in zip(axes.get_yticklabels(), people, strict=True):
        label.set(color=person_color(person.id), fontweight="bold", fontsize=11)
    axes.grid(axis="x", color="#ecebe6", lw=0.6)
    axes.set_axisbelow(True)
    axes.spines[:].set_visible(False)
    if not people:
        axes.text(
            0.5, 0.5, "nobody was confirmed", transform=axes.transAxes, ha="center", color=FADED
        )
    handles = [
        Line2D([], [], color=INK, lw=1.1, label="exists (0 to 1)"),
        Patch(fc=FADED, label="raised (person's color)"),
        Patch(fc=_FRESH, label="fresh"),
        Patch(fc=LIT, label="served"),
    ]
    figure.legend(
        handles=handles, loc="outside upper center", ncols=4, frameon=False, fontsize=9,
        labelcolor=INK, handlelength=1.4, columnspacing=1.4,
    )  # fmt: skip
    return figure


def _draw_lane(
    axes: Axes, history: History, person: Person, states: PersonStates, y: float
) -> None:
    at_s, end_ns = states.at_s, history.end_ns or person.last_seen_ns

    def bars(spans: Iterable[Span]) -> list[tuple[float, float]]:
        starts = [(history.seconds(span.start_ns), span) for span in spans]
        stops = [history.seconds(end_ns if s.end_ns is None else s.end_ns) for _, s in starts]
        return [(start, stop - start) for (start, _), stop in zip(starts, stops, strict=True)]

    base = y - 0.02
    axes.fill_between(
        at_s, base, base + _EXISTS_HIGH * states.existence, color=FADED, alpha=0.18, lw=0
    )
    axes.plot(at_s, base + _EXISTS_HIGH * states.existence, color=INK, lw=1.1)
    rows = (
        (bars(person.hands), person_color(person.id)),
        (_runs(at_s, states.is_fresh > 0.5), _FRESH),
        (bars(person.selected), LIT),
    )
    for place, (spans, color) in enumerate(rows):
        low = base - 0.03 - (place + 1) * (_BAR_HIGH + 0.02)
        axes.broken_barh(spans, (low, _BAR_HIGH), facecolors=color, linewidths=0)


def _runs(at_s: np.ndarray, is_on: np.ndarray) -> list[tuple[float, float]]:
    """Starts and lengths of the times in which something held, from row to row."""
    edges = np.flatnonzero(np.diff(np.r_[False, is_on, False].astype(int)))
    stops = np.minimum(edges[1::2], len(at_s) - 1)
    return [
        (float(at_s[a]), float(at_s[b] - at_s[a])) for a, b in zip(edges[::2], stops, strict=True)
    ]
