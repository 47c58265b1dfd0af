"""How does a Monte Carlo study look in a terminal, and in a file?"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tracker.evaluation.studies.study import Figure, PeopleStudy, Study, study_as_dict
from tracker.outputs import writing_into
from tracker.report.studies.study_plot import draw_study
from tracker.wording import counted

STUDY_FILES = ("study.json", "study.png", "trials.parquet")

if TYPE_CHECKING:
    from rich.table import Table


def study_table(study: Study) -> Table:
    """One line per figure: its interval, what a perfect filter would show, and what is good."""
    from rich.table import Table

    table = Table(
        title=f"{study.name}: {counted(study.trials, 'trial')} of seed {study.seed}\n"
        f"{study.scenario.title}",
        title_justify="left",
        caption=study.remark if isinstance(study, PeopleStudy) else None,
        caption_justify="left",
    )
    table.add_column("figure")  # wraps where the terminal is narrow; numbers never do
    for name in ("value", "95 % interval", "expected", "good is"):
        table.add_column(name, justify="right", no_wrap=True)
    for figure in study.figures:
        value = "-" if np.isnan(figure.value) else f"{figure.value:.3f}".removesuffix(".000")
        style = "red" if figure.as_expected is False else ""
        cells = (value, _interval(figure), _expected(figure), figure.good)
        table.add_row(figure.name, *cells, style=style)
    return table


def write_study(study: Study, folder: str | Path) -> tuple[Path, ...]:
    """Write study.json (the figures) and study.png.

    Args:
        study: What was found.
        folder: Made where it is missing; what is there is replaced.

    Returns:
        The files.

    Raises:
        RecordingError: A file cannot be written.
    """
    document, picture = (Path(folder) / name for name in STUDY_FILES[:2])
    with writing_into(folder) as new:
        text = json.dumps(study_as_dict(study), indent=1) + "\n"
        new(document.name).write_text(text, encoding="utf-8")
        draw_study(study, new(picture.name))
    return document, picture


def write_parquet(study: Study, folder: str | Path) -> Path:
    """Write trials.parquet, a row per trial, with pyarrow (extra `cluster`).

    Args:
        study: What was found.
        folder: Made where it is missing; the file is replaced.

    Returns:
        The file.

    Raises:
        RecordingError: It cannot be written.
    """
    import pyarrow
    from pyarrow import parquet

    path = Path(folder) / STUDY_FILES[2]
    with writing_into(folder) as new:
        trials = pyarrow.array(np.arange(study.trials))
        table = pyarrow.table({"trial": trials, **study.rows})
        parquet.write_table(table, new(path.name))
    return path


def _interval(figure: Figure) -> str:
    return "" if np.isnan(figure.low) else f"{figure.low:.3f} to {figure.high:.3f}"


def _expected(figure: Figure) -> str:
    return "" if figure.expected is None else "{:.3f} to {:.3f}".format(*figure.expected)
