"""What did a Monte Carlo study find, in one picture?"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from tracker.containers import FloatArray
from tracker.evaluation.metrics.consistency import mean_bounds
from tracker.evaluation.studies.study import FilterStudy, KnownPeopleStudy, PeopleStudy, Study
from tracker.report.palette import FADED, INK, LIT, PAPER, PERSON_COLORS
from tracker.report.studies.trial_words import trial_words
from tracker.wording import counted

_GOSPA_PARTS = {
    "localisation": "error of places", "missed": "people missed", "false": "false tracks",
}  # fmt: skip
_KNOWN_PEOPLE = ("mse_m2", "final_nees", "wrong_share", "swapped_share")
_DISTRIBUTIONS = (
    "gospa_m", "identity_switches_per_min", "time_to_raise_s",
    "rmse_m", "nees_position", "covered_share",
)  # fmt: skip


def draw_study(study: Study, path: str | Path) -> None:
    """Draw a study: error and NEES over time of a filter, spread over the trials otherwise.

    Args:
        study: What was found.
        path: The .png file, replaced if it exists.

    Raises:
        OSError: The file cannot be written.
    """
    figure = Figure(figsize=(13.0, 4.8), dpi=160, facecolor=PAPER, layout="constrained")
    if isinstance(study, FilterStudy):
        error, nees = figure.subplots(1, 2)
        draw_filter(error, nees, study)
    elif isinstance(study, KnownPeopleStudy):
        for axes, name in zip(figure.subplots(1, 4), _KNOWN_PEOPLE, strict=True):
            draw_distribution(axes, study.rows[name], trial_words(name))
    else:
        _draw_people(figure, study)
    lines = "" if isinstance(study, FilterStudy) else "; upright lines: the means"
    figure.suptitle(
        f"{study.name}: {counted(study.trials, 'trial')} of seed {study.seed}{lines}", color=INK
    )
    figure.savefig(path, format="png")


def draw_filter(error: Axes, nees: Axes, study: FilterStudy) -> None:
    """Draw a filter's error beside its bound, and its NEES beside its ideal, over time."""
    at_s = (1 + np.arange(len(study.nees))) / study.scenario.rate_hz
    error.plot(at_s, np.sqrt(study.squared_error_m2), color=PERSON_COLORS[0], label="RMSE")
    error.plot(at_s, np.sqrt(study.bound_m2), "--", color=INK, label="Cramer-Rao bound")
    error.set(xlabel="time (s)", ylabel="position error (m); less is better", ylim=(0.0, None))
    error.legend(frameon=False)
    low, high = mean_bounds(4, study.trials)
    nees.axhspan(low, high, color=LIT, alpha=0.3, label="95 % of perfect filters")
    nees.axhline(4.0, color=FADED, linewidth=0.8)
    nees.plot(at_s, study.nees, color=PERSON_COLORS[1], label="mean NEES")
    nees.set(xlabel="time (s)", ylabel="NEES (ideal 4)")
    nees.legend(frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    _plain(error)
    _plain(nees)


def _draw_people(figure: Figure, study: PeopleStudy) -> None:
    grid = figure.add_gridspec(2, 5)
    draw_gospa_parts(figure.add_subplot(grid[:, :2]), study)
    for place, name in enumerate(_DISTRIBUTIONS):
        axes = figure.add_subplot(grid[place // 3, 2 + place % 3])
        draw_distribution(axes, study.rows[name], trial_words(name))


def draw_gospa_parts(axes: Axes, study: PeopleStudy) -> None:
    """Draw each trial's GOSPA by its parts, the best trial first."""
    order = np.argsort(sum(study.rows[f"gospa_{part}"] for part in _GOSPA_PARTS))
    below = np.zeros(study.trials)
    for (part, words), color in zip(_GOSPA_PARTS.items(), PERSON_COLORS, strict=False):
        values = study.rows[f"gospa_{part}"][order]
        axes.bar(np.arange(study.trials), values, 1.0, below, color=color, label=words)
        below += values
    axes.set(xlabel="trials, best first", ylabel="GOSPA squared, by parts (m²)")
    axes.set_xticks([])
    axes.set_ylim(0.0, 1.25 * max(float(below.max()), 1e-9))  # room for the legend
    axes.legend(frameon=False, loc="upper left", ncols=len(_GOSPA_PARTS), columnspacing=1.0)
    _plain(axes)


def draw_distribution(axes: Axes, values: FloatArray, title: str) -> None:
    """Draw how often each value came, and their mean as a line.

    Args:
        axes: Where to draw.
        values: Shape (B,), one of each trial; NaN where nothing was measured.
        title: What they are, with the unit.
    """
    values = values[np.isfinite(values)]
    if len(values):
        axes.hist(values, bins=min(20, max(5, len(values) // 4)), color=PERSON_COLORS[0])
        axes.axvline(float(values.mean()), color=INK, linewidth=1.2)
    axes.set_xlabel(title, fontsize=9, wrap=True)
    axes.set_ylabel("trials", fontsize=9)
    axes.yaxis.set_major_locator(MaxNLocator(integer=True, nbins=5))
    _plain(axes)


def _plain(axes: Axes) -> None:
    axes.set_facecolor(PAPER)
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(colors=INK, labelsize=8)
