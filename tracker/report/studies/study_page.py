"""The page of a study: figures with their expectations, spreads, and the worst trials."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from tracker.evaluation.studies.study import FilterStudy, PeopleStudy, Study
from tracker.report.page import Facts, Page, Part, Picture, Section, Table, Text
from tracker.report.palette import PAPER
from tracker.report.provenance import provenance_section, settings_section
from tracker.report.studies.study_plot import draw_distribution, draw_filter, draw_gospa_parts
from tracker.report.studies.study_table import study_table
from tracker.report.studies.trial_words import trial_words
from tracker.wording import counted

_WORST = 8
_HEADLINES = 4
_QUANTILES = (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0)


def study_page(study: Study, *, command: str = "") -> Page:
    """The page of a Monte Carlo study.

    Args:
        study: What was found.
        command: As typed.
    """
    sections = (
        Section("In short", (Text((study.scenario.title,)), _headlines(study))),
        Section(
            "Figures", (replace(Table.from_rich(study_table(study)), title=""), *_verdict(study))
        ),
        Section("Plots", _plots(study)),
        Section("Spread over the trials", (*_histograms(study), _quantiles(study))),
        Section("Worst trials", _worst(study)),
        settings_section(study.config),
        provenance_section(command),
    )
    subtitle = f"{counted(study.trials, 'trial')} of seed {study.seed}"
    return Page(f"Monte Carlo study: {study.name}", subtitle, sections)


def _headlines(study: Study) -> Facts:
    known = [
        figure
        for figure in study.figures
        if np.isfinite(figure.value) and not figure.name.startswith(" ")  # a part of another one
    ]
    return Facts(
        tuple(
            (
                figure.name.strip(),
                f"{figure.value:.3g}",
                f"{figure.low:.3g} to {figure.high:.3g}" if np.isfinite(figure.low) else "",
            )
            for figure in known[:_HEADLINES]
        )
    )


def _verdict(study: Study) -> tuple[Part, ...]:
    if isinstance(study, PeopleStudy):
        return (Text((study.remark,)),)
    judged = [figure for figure in study.figures if figure.as_expected is not None]
    if not judged:
        return ()
    off = [figure.name.strip() for figure in judged if not figure.as_expected]
    if off:
        return (Text((f"Outside the interval of a perfect filter: {', '.join(off)}.",)),)
    return (Text(("Every figure with an expectation lies in its interval.",)),)


def _plots(study: Study) -> tuple[Part, ...]:
    if isinstance(study, FilterStudy):
        figure = Figure(figsize=(6.6, 6.4), facecolor=PAPER, layout="constrained")
        error, nees = figure.subplots(2, 1)
        draw_filter(error, nees, study)
        words = "Means over the trials. Good: an error near the bound, a NEES inside the band."
        return (Picture.plot(figure, words),)
    if isinstance(study, PeopleStudy):
        figure = Figure(figsize=(6.6, 3.6), facecolor=PAPER, layout="constrained")
        draw_gospa_parts(figure.add_subplot(), study)
        words = "GOSPA of each trial by its parts; less is better."
        return (Picture.plot(figure, words),)
    return ()


def _histograms(study: Study) -> tuple[Part, ...]:
    """One of each figure of the trials that is not the same in all of them."""
    varied = {
        name: values
        for name, values in study.rows.items()
        if len(np.unique(values[np.isfinite(values)])) > 1
    }
    if not varied:
        return ()
    lines = -(-len(varied) // 3)
    figure = Figure(figsize=(6.6, 1.9 * lines), facecolor=PAPER, layout="constrained")
    grid = figure.subplots(lines, 3, squeeze=False).flat
    for axes, (name, values) in zip(grid, varied.items(), strict=False):
        draw_distribution(axes, values, trial_words(name))
    for axes in list(grid.base.flat)[len(varied) :]:
        axes.set_axis_off()
    return (Picture.plot(figure, "In how many trials each value occurred; the line is the mean."),)


def _quantiles(study: Study) -> Table:
    rows = []
    for name, values in study.rows.items():
        finite = values[np.isfinite(values)]
        cells = ["-"] * len(_QUANTILES)
        if len(finite):
            cells = [f"{value:.3g}" for value in np.quantile(finite, _QUANTILES)]
        rows.append((trial_words(name), *cells, str(len(values) - len(finite))))
    names = ("smallest", "5 %", "25 %", "median", "75 %", "95 %", "largest")
    columns = ("figure of a trial", *names, "trials without")
    return Table(columns, tuple(rows), numeric=frozenset(range(1, len(columns))))


def _worst(study: Study) -> tuple[Part, ...]:
    name = "gospa_m" if isinstance(study, PeopleStudy) else "mse_m2"
    values = np.where(np.isfinite(study.rows[name]), study.rows[name], np.inf)
    worst = np.argsort(-values, kind="stable")[:_WORST].tolist()
    shown = [key for key in study.rows if key != name][:6]
    rows = tuple(
        (str(trial), *(f"{study.rows[key][trial]:.3g}" for key in (name, *shown)))
        for trial in worst
    )
    columns = ("trial", *map(trial_words, (name, *shown)))
    table = Table(columns, rows, numeric=frozenset(range(len(columns))))
    again = (
        "Trial i of a seed is the same in every study. From Python, with the study's scenario and "
        f"config: tracker.evaluation.studies.monte_carlo.run_unit(scenario, config, {study.seed}, "
        f"{worst[0]}, 1) repeats the first of these alone."
    )
    return table, Text((again,))
