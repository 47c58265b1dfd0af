"""How do figures of studies look? Settings for `matplotlib.rcParams.update`."""

from __future__ import annotations

from types import MappingProxyType
from typing import Any

from cycler import cycler

from tracker.report.palette import FADED, INK, PAPER, PERSON_COLORS

FIGURE_STYLE: MappingProxyType[str, Any] = MappingProxyType(
    {
        "figure.figsize": (9.0, 3.8),
        "figure.dpi": 110,
        "figure.facecolor": PAPER,
        "figure.constrained_layout.use": True,
        "axes.facecolor": PAPER,
        "axes.edgecolor": FADED,
        "axes.labelcolor": INK,
        "axes.titlecolor": INK,
        "axes.titlesize": "medium",
        "axes.titlelocation": "left",
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.prop_cycle": cycler(color=PERSON_COLORS),
        "xtick.color": INK,
        "ytick.color": INK,
        "text.color": INK,
        "legend.frameon": False,
    }
)
