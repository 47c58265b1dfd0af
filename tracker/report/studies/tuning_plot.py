"""What did a search for parameters find, in one picture?"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

from tracker.config import parameter_extra, parameter_search
from tracker.evaluation.tuning.result import Tuning
from tracker.report.palette import FADED, INK, LIT, PAPER, PERSON_COLORS
from tracker.wording import counted

#: Slices that fit below one another and still can be read.
_SLICES = 8
#: From this share on only powers of ten are written below an axis: more would touch each other.
_WIDE = 200.0


def draw_tuning(tuning: Tuning, path: str | Path) -> None:
    """Draw a search into a file.

    Args:
        tuning: What was found.
        path: The .png file, replaced if it exists.

    Raises:
        OSError: The file cannot be written.
    """
    tuning_figure(tuning).savefig(path, format="png")


def tuning_figure(tuning: Tuning) -> Figure:
    """The search, its verdict, and the figure along the parameters that matter most."""
    names = sorted(tuning.names, key=lambda name: -tuning.importance.get(name, 0.0))[:_SLICES]
    rows = -(-len(names) // 4)
    figure = Figure(figsize=(11.0, 3.6 + 2.3 * rows), dpi=150, facecolor=PAPER)
    figure.set_layout_engine("constrained")
    grid = figure.add_gridspec(1 + rows, 4, height_ratios=[1.5, *[1.0] * rows])
    _draw_history(figure.add_subplot(grid[0, :2]), tuning)
    _draw_unseen(figure.add_subplot(grid[0, 2:]), tuning)
    first = None
    for place, name in enumerate(names):
        axes = figure.add_subplot(grid[1 + place // 4, place % 4], sharey=first)
        first = first or axes
        _draw_slice(axes, tuning, name)
        if place % 4 == 0:
            axes.set_ylabel(tuning.figure, fontsize=8)
    figure.suptitle(f"{tuning.source}: {counted(tuning.trials, 'trial')}", color=INK)
    return figure


def _draw_history(axes: Axes, tuning: Tuning) -> None:
    axes.plot(tuning.number, tuning.value, ".", color=FADED, label="a trial")
    axes.step(
        tuning.number,
        tuning.best_so_far,
        where="post",
        color=PERSON_COLORS[0],
        label="best so far",
    )
    axes.set(
        title="trials of the search ({} is better)".format("less" if tuning.is_cost else "more"),
        xlabel="trial",
        ylabel=tuning.figure,
        ylim=_limits(tuning),
    )
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.legend(frameon=False)
    _plain(axes)


def _draw_unseen(axes: Axes, tuning: Tuning) -> None:
    """Each part as a point: its figure before and after. Off the diagonal is what was gained."""
    before, after = tuning.unseen_base, tuning.unseen_best
    ends = [min(before.min(), after.min()), max(before.max(), after.max())]
    axes.plot(ends, ends, "--", color=FADED, linewidth=0.8)
    axes.plot(before, after, "o", color=PERSON_COLORS[2], markersize=4, alpha=0.7, label="a part")
    axes.plot(
        before.mean(),
        after.mean(),
        "D",
        color=LIT,
        markeredgecolor=INK,
        markersize=8,
        label="mean",
    )
    side = "below" if tuning.is_cost else "above"
    axes.set(
        title=f"final test on other data ({side} the line is better)",
        xlabel=f"before: {tuning.figure}",
        ylabel="tuned",
    )
    axes.legend(frameon=False)
    _plain(axes)


def _draw_slice(axes: Axes, tuning: Tuning, name: str) -> None:
    search, unit = parameter_search(name), parameter_extra(name)["unit"]
    tried = tuning.tried[name]
    axes.plot(tried, tuning.value, ".", color=FADED, markersize=4)
    marks = [(getattr(tuning.base, name), INK, "|"), (getattr(tuning.best, name), LIT, "D")]
    low, high = _limits(tuning)
    for value, color, marker in marks:
        axes.plot([value], [low + 0.04 * (high - low)], marker, color=color, markersize=8,
                  markeredgecolor=INK, clip_on=False)  # fmt: skip
    if search is not None and search.log:
        axes.set_xscale("log")
        is_wide = max(tried) > _WIDE * min(tried)
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0,) if is_wide else (1.0, 3.0)))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter(NullFormatter())
    share = tuning.importance.get(name)
    words = "" if share is None else f"  {share:.0%}"
    axes.set_title(f"{name}{words}", fontsize=8, color=INK)
    axes.set_xlabel(unit, fontsize=8)
    axes.set_ylim(low, high)
    _plain(axes)


def _limits(tuning: Tuning) -> tuple[float, float]:
    """Room for the better trials; the worst few would press all others flat."""
    worst, best = (95, 0) if tuning.is_cost else (5, 100)
    ends = sorted(np.percentile(tuning.value, [best, worst]).tolist())
    margin = 0.08 * (ends[1] - ends[0]) or 0.1
    return ends[0] - 2.0 * margin, ends[1] + margin


def _plain(axes: Axes) -> None:
    axes.set_facecolor(PAPER)
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(colors=INK, labelsize=8)
