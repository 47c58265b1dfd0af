"""The page of a search: the final test, the best parameters, and all trials."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracker.evaluation.tuning.result import Tuning
from tracker.report.page import Facts, Page, Picture, Section, Table, Text
from tracker.report.provenance import provenance_section, settings_section
from tracker.report.studies.tuning_plot import tuning_figure
from tracker.report.studies.tuning_table import parameters_table, verdict_table
from tracker.wording import counted


def tuning_page(tuning: Tuning, *, command: str = "") -> Page:
    """The page of a search for parameters.

    Args:
        tuning: What was found.
        command: As typed.
    """
    verdict = replace(Table.from_rich(verdict_table(tuning)), title="")
    parameters = replace(Table.from_rich(parameters_table(tuning)), title="")
    plot = Picture.plot(
        tuning_figure(tuning),
        "Top left: trials and the best so far. Top right: each part of the final test, before and "
        "after. Below: the figure along the parameters that matter most (bar: before, diamond: "
        "tuned).",
    )
    sections = (
        Section("In short", (_headlines(tuning), Text((_in_words(tuning),)))),
        Section("Final test, on data that the search has not used", (verdict,)),
        Section("Parameters", (parameters,)),
        Section("Plots", (plot,)),
        settings_section(tuning.best),
        provenance_section(command),
    )
    subtitle = f"best of {counted(tuning.trials, 'trial')} (number {tuning.best_trial})"
    return Page(f"Tuned on {tuning.source}", subtitle, sections)


def _headlines(tuning: Tuning) -> Facts:
    gain, low, high = tuning.gain
    before, after = tuning.unseen_base.mean(), tuning.unseen_best.mean()
    interval = f"{low:.3g} to {high:.3g}" if np.isfinite(low) else ""
    return Facts(
        (
            (f"before, {tuning.figure}", f"{before:.3g}", ""),
            ("tuned", f"{after:.3g}", ""),
            ("gain", f"{gain:.3g}", interval),
        )
    )


def _in_words(tuning: Tuning) -> str:
    _, low, high = tuning.gain
    if tuning.best == tuning.base:
        return "No trial is better than the parameters from before."
    if low > 0.0:
        return "Better on data that the search has not used; chance does not explain it."
    if high < 0.0:
        return "Worse on data that the search has not used: keep the parameters from before."
    return "No clear difference on data that the search has not used: test on more of it."
