"""What does one unit of work of a study give, and what do all of them together?"""

from __future__ import annotations

from array import array
from dataclasses import dataclass, field

import numpy as np

from tracker.containers import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Unit:
    """What one unit of work gives.

    Attributes:
        rows: Figures of each trial, shape (B,).
        sums: Of a filter scenario, over the trials: arrays of shape (T, ...).
    """

    rows: dict[str, FloatArray]
    sums: dict[str, FloatArray] = field(default_factory=dict)


class Gathered:
    """Rows and sums of units, in the order in which they are added.

    A million trials are a million units' worth of small arrays; here a number takes its 8 bytes.
    """

    def __init__(self) -> None:
        self._rows: dict[str, array[float]] = {}
        self._sums: dict[str, FloatArray] = {}

    def add(self, unit: Unit) -> None:
        """Put a unit behind those that are here."""
        for name, values in unit.rows.items():
            self._rows.setdefault(name, array("d")).extend(values.tolist())
        for name, values in unit.sums.items():
            self._sums[name] = self._sums.get(name, 0.0) + values

    def rows(self) -> dict[str, FloatArray]:
        """Figures of each trial, shape (B,)."""
        return {name: np.frombuffer(values) for name, values in self._rows.items()}

    def means(self, trials: int) -> dict[str, FloatArray]:
        """The sums over so many trials, divided by their number."""
        return {name: values / trials for name, values in self._sums.items()}
