"""What did a search find, and is it better on data that the search did not use?"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import t as student_t

from tracker.config import Config
from tracker.containers import FloatArray, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Tuning:
    """A search and its verdict.

    Attributes:
        source: Scenario or recording.
        figure: What was measured, with its unit.
        is_cost: Less is better.
        names: Parameters that were searched.
        base: What the best is held against.
        best: The best of the trials.
        best_trial: Its number.
        trials: How many were begun and ended, those cut short included.
        number: Shape (K,): of the trials that came to their end ...
        value: ... and their figures, on what the search has seen ...
        tried: ... and their parameters, K of each.
        importance: Of each parameter, adding up to 1; empty where too little was tried.
        unseen_base: Shape (U,): the base's figures on what the search has never seen ...
        unseen_best: ... and the best's, in the same order.
    """

    source: str
    figure: str
    is_cost: bool
    names: tuple[str, ...]
    base: Config
    best: Config
    best_trial: int
    trials: int
    number: IntArray
    value: FloatArray
    tried: dict[str, tuple[Any, ...]]
    importance: dict[str, float]
    unseen_base: FloatArray
    unseen_best: FloatArray

    @property
    def gain(self) -> tuple[float, float, float]:
        """How much better the best is on the unseen, in the figure's unit, with its 95 % interval.

        The interval is Student's, of the paired differences.
        """
        difference = self.unseen_best - self.unseen_base
        difference = -difference if self.is_cost else difference
        mean, count = float(difference.mean()), len(difference)
        if count < 2:
            return mean, float("-inf"), float("inf")
        error = float(difference.std(ddof=1) / np.sqrt(count))
        half = float(student_t.ppf(0.975, count - 1)) * error
        return mean, mean - half, mean + half

    @property
    def relative_gain(self) -> float:
        """The same as a share of the base's cost; NaN where the figure is no cost."""
        return self.gain[0] / float(self.unseen_base.mean()) if self.is_cost else float("nan")

    @property
    def best_so_far(self) -> FloatArray:
        """Shape (K,): the best figure up to each trial."""
        running = np.minimum if self.is_cost else np.maximum
        return np.asarray(running.accumulate(self.value))


def tuning_as_dict(tuning: Tuning) -> dict[str, Any]:
    """A search in plain numbers, fit for JSON."""
    gain, low, high = tuning.gain
    return {
        "source": tuning.source,
        "figure": tuning.figure,
        "less_is_better": tuning.is_cost,
        "trials": tuning.trials,
        "best_trial": tuning.best_trial,
        "parameters": {
            name: {
                "base": getattr(tuning.base, name),
                "best": getattr(tuning.best, name),
                "importance": tuning.importance.get(name),
            }
            for name in tuning.names
        },
        "unseen": {
            "parts": len(tuning.unseen_base),
            "base": float(tuning.unseen_base.mean()),
            "best": float(tuning.unseen_best.mean()),
            "gain": gain,
            "gain_interval_95": [low, high] if np.isfinite(low) else None,
            "relative_gain": tuning.relative_gain if tuning.is_cost else None,
            "base_parts": tuning.unseen_base.tolist(),
            "best_parts": tuning.unseen_best.tolist(),
        },
        "history": [
            {"trial": int(number), "value": float(value)}
            for number, value in zip(tuning.number, tuning.value, strict=True)
        ],
    }
