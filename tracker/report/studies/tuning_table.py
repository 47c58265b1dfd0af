"""How does a search for parameters look in a terminal, and in files that a robot can load?"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tracker.config_file import parameter_yaml
from tracker.evaluation.tuning.result import Tuning, tuning_as_dict
from tracker.outputs import writing_into
from tracker.report.studies.tuning_plot import draw_tuning
from tracker.wording import counted

TUNING_FILES = ("best.yaml", "tuning.json", "tuning.png")

if TYPE_CHECKING:
    from rich.table import Table


def parameters_table(tuning: Tuning) -> Table:
    """One line per parameter, those that matter most first."""
    from rich.table import Table

    table = Table(
        title=f"{tuning.source}: best of {counted(tuning.trials, 'trial')}", title_justify="left"
    )
    table.add_column("parameter", no_wrap=True)
    for name in ("before", "tuned", "importance"):
        table.add_column(name, justify="right", no_wrap=True)
    table.caption = "importance: share of the parameter in what makes trials good or bad"
    table.caption_justify = "left"
    for name in sorted(tuning.names, key=lambda name: -tuning.importance.get(name, 0.0)):
        share = tuning.importance.get(name)
        values = (_short(getattr(config, name)) for config in (tuning.base, tuning.best))
        table.add_row(name, *values, "" if share is None else f"{share:.0%}")
    return table


def verdict_table(tuning: Tuning) -> Table:
    """Before against tuned, on data that the search has not used."""
    from rich.table import Table

    count = len(tuning.unseen_base)
    table = Table(title=f"final test on {count} parts that no trial used", title_justify="left")
    for name in (tuning.figure, "before", "tuned", "gain", "95 % interval"):
        table.add_column(name, justify="left" if name == tuning.figure else "right")
    gain, low, high = tuning.gain
    before, after = tuning.unseen_base.mean(), tuning.unseen_best.mean()
    known = np.isfinite(low)
    interval = f"{low:.3f} to {high:.3f}" if known else "-"
    table.add_row("mean", f"{before:.3f}", f"{after:.3f}", f"{gain:.3f}", interval)
    better = "less" if tuning.is_cost else "more"
    table.caption = f"{better} is better; a gain whose interval is above 0 is real"
    table.caption_justify = "left"
    if tuning.is_cost:
        interval = f"{low / before:.1%} to {high / before:.1%}" if known else "-"
        table.add_row("  in percent of before", "", "", f"{gain / before:.1%}", interval)
    return table


def write_tuning(tuning: Tuning, folder: str | Path) -> tuple[Path, ...]:
    """Write best.yaml (for `Config.from_yaml` and the node), tuning.json and tuning.png.

    Args:
        tuning: What was found.
        folder: Made where it is missing; what is there is replaced.

    Returns:
        The files.

    Raises:
        RecordingError: A file cannot be written.
    """
    folder = Path(folder)
    best, document, picture = (folder / name for name in TUNING_FILES)
    title = f"Tuned on {tuning.source}: trial {tuning.best_trial} of {tuning.trials}."
    with writing_into(folder) as new:
        new(best.name).write_text(parameter_yaml(tuning.best, title), encoding="utf-8")
        text = json.dumps(tuning_as_dict(tuning), indent=1) + "\n"
        new(document.name).write_text(text, encoding="utf-8")
        draw_tuning(tuning, new(picture.name))
    return best, document, picture


def _short(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
