"""How sure is a difference between trackers that were given the same measurements?"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from rich import box
from rich.table import Table

#: Figures of one scene, by tracker and by the figure's name.
Rows = Mapping[str, Mapping[str, float]]


def comparison(title: str, figures: Mapping[str, str], scenes: Sequence[Rows]) -> Table:
    """Means of every tracker, and differences from the first, paired by scene.

    Args:
        title: Above the table.
        figures: What to show: names in the rows, and words for them.
        scenes: The same trackers in each; NaN where there was nothing to measure.
    """
    table = Table(title=title, title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    first, *others = scenes[0]
    for column in ("", "tracker", "mean", "difference", "95 % interval"):
        justify = "left" if column in ("", "tracker") else "right"
        table.add_column(column, justify=justify, no_wrap=True)
    rng = np.random.default_rng(0)
    for figure, words in figures.items():
        of = {name: np.array([rows[name][figure] for rows in scenes]) for name in scenes[0]}
        table.add_row(words, first, f"{mean(of[first]):.3f}", "", "")
        for name in others:
            difference = of[name] - of[first]
            low, high = paired_interval(difference, rng)
            middle = f"{mean(difference):+.3f}"
            table.add_row("", name, f"{mean(of[name]):.3f}", middle, f"{low:+.3f} to {high:+.3f}")
        table.add_section()
    return table


def mean(values: Sequence[float] | np.ndarray) -> float:
    """Of the finite values; NaN where there are none."""
    finite = np.asarray(values)[np.isfinite(values)]
    return float(finite.mean()) if len(finite) else float("nan")


def paired_interval(difference: np.ndarray, rng: np.random.Generator) -> tuple[float, float]:
    """95 % bootstrap interval of the mean; NaN at both ends where there is nothing to compare."""
    difference = difference[np.isfinite(difference)]
    if len(difference) == 0:
        return float("nan"), float("nan")
    means = rng.choice(difference, (4000, len(difference))).mean(axis=1)
    low, high = np.quantile(means, [0.025, 0.975])
    return float(low), float(high)
