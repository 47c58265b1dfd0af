"""One plot of an evaluation: recall by distance and other factors, and false raises."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tracker.evaluation.detection.episode import FRAMES_TO_FIND
from tracker.evaluation.detection.figures import (
    FalseRate,
    Recall,
    false_rate,
    false_rate_by_activity,
    recall_by_factor,
    recall_of,
)
from tracker.evaluation.detection.study import DetectionStudy
from tracker.report.palette import FADED, INK, PAPER, PERSON_COLORS
from tracker.wording import counted

_RECALL, _FALSE = PERSON_COLORS[0], PERSON_COLORS[1]
_TITLES = {"size": "length of the hand"}
_SMALL = ("size", "light", "blur", "skin", "sleeve", "hand", "style", "company")


def draw_detection(study: DetectionStudy, path: str | Path) -> None:
    """Draw the share of hands found against distance and other factors, and false raises.

    What was not played is left out.

    Args:
        study: What was found.
        path: The .png file, replaced if it exists.

    Raises:
        OSError: The file cannot be written.
    """
    rows = 3 if study.episodes else 1
    figure = Figure(
        figsize=(12.0, 9.6 if study.episodes else 4.0), dpi=140, facecolor=PAPER,
        layout="constrained",
    )  # fmt: skip
    grid = figure.add_gridspec(rows, 4, height_ratios=(1.5, 1.0, 1.0)[:rows])
    total = recall_of("all", study.episodes)
    if study.episodes:
        by_factor = recall_by_factor(study)
        _draw_distance(figure.add_subplot(grid[0, :2]), study, by_factor["distance"])
        for place, name in enumerate(_SMALL):
            axes = figure.add_subplot(grid[1 + place // 4, place % 4])
            _draw_levels(axes, name, by_factor[name], total)
    if study.minutes:
        _draw_false(figure.add_subplot(grid[0, 2:]), study)
    figure.suptitle(
        f"{total.found} of {total.total} raised hands found within {FRAMES_TO_FIND} images; "
        f"{false_rate(study.minutes).count} false raises in "
        f"{counted(len(study.minutes), 'minute')}\n"
        f"seed {study.seed}; bars: 95 % intervals; gray lines: the share of all hands, and one "
        "false raise an hour",
        color=INK,
    )
    figure.savefig(path, format="png")


def _draw_distance(axes: Axes, study: DetectionStudy, rows: Sequence[Recall]) -> None:
    at_m = [item for item in study.distances_m if f"{item:g} m" in {row.level for row in rows}]
    shares = np.array([row.share for row in rows])
    bars = np.array([(row.share - row.low, row.high - row.share) for row in rows]).reshape(-1, 2)
    axes.errorbar(
        at_m, shares, bars.T, color=_RECALL, marker="o", capsize=4, linewidth=1.6, clip_on=False
    )
    for distance_m, row in zip(at_m, rows, strict=True):
        axes.annotate(
            f"{row.found}/{row.total}", (distance_m, row.high), (0, 7), fontsize=8, color=INK,
            textcoords="offset points", ha="center", annotation_clip=False,
        )  # fmt: skip
    axes.set(
        xlabel="distance (m)",
        ylabel="share of raised hands found",
        ylim=(0.0, 1.08),
        title="found, by distance",
    )
    axes.set_xticks(at_m)
    axes.set_yticks(np.linspace(0.0, 1.0, 6))
    _plain(axes)


def _draw_levels(axes: Axes, name: str, rows: Sequence[Recall], total: Recall) -> None:
    at = np.arange(len(rows))
    shares = np.array([row.share for row in rows])
    bars = np.array([(row.share - row.low, row.high - row.share) for row in rows]).reshape(-1, 2)
    axes.axvline(total.share, color=FADED, linewidth=0.8)
    axes.errorbar(shares, at, xerr=bars.T, color=_RECALL, marker="o", linestyle="none", capsize=3)
    axes.set_yticks(at, [f"{row.level} ({row.total})" for row in rows])
    axes.set(
        xlim=(-0.02, 1.02),
        ylim=(len(rows) - 0.5, -0.5),
        title=f"found, by {_TITLES.get(name, name)}",
    )
    axes.set_xticks((0.0, 0.5, 1.0))
    _plain(axes)


def _draw_false(axes: Axes, study: DetectionStudy) -> None:
    rows = false_rate_by_activity(study.minutes)
    rows = [*sorted(rows, key=lambda row: row.level), false_rate(study.minutes)]
    at = np.arange(len(rows))
    rates = np.array([row.per_hour for row in rows])
    bars = np.array([(row.per_hour - row.low, row.high - row.per_hour) for row in rows])
    axes.errorbar(
        rates, at, xerr=bars.reshape(-1, 2).T, color=_FALSE, marker="o", linestyle="none",
        capsize=3,
    )  # fmt: skip
    # Rates span from a fraction to hundreds, and nothing at all is the best of them.
    axes.set_xscale("symlog", linthresh=1.0)
    axes.axvline(1.0, color=FADED, linewidth=0.8)
    axes.xaxis.set_major_formatter(lambda rate, _: f"{rate:g}")
    axes.set_yticks(at, [_false_label(row) for row in rows])
    axes.set(xlabel="false raises an hour", title="false raises while nobody calls (0 is perfect)")
    axes.set(xlim=(-0.1, None), ylim=(len(rows) - 0.5, -0.5))
    _plain(axes)


def _false_label(row: FalseRate) -> str:
    who = "all together" if row.level == "nobody calls" else row.level.replace("_", " ")
    return f"{who} ({row.count} in {row.hours:.2f} h)"


def _plain(axes: Axes) -> None:
    axes.set_facecolor(PAPER)
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(colors=INK, labelsize=8)
    axes.title.set_fontsize(10)
    axes.grid(color=FADED, alpha=0.2, linewidth=0.6)
