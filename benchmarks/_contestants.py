"""The trackers that benchmarks compare, by name, and how sure a difference between them is."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias, get_args

import numpy as np

from tracker import Config, PersonTracker, Tracks
from tracker.evaluation.trials.people_sensing import Sensed
from tracker.tracking.reference import ReferenceTracker, as_positions

#: Takes in one frame: its stamp in nanoseconds and what the sensors gave.
Follow: TypeAlias = Callable[[int, Sensed], Tracks]


REFERENCE = "reference"


def contestants() -> tuple[str, ...]:
    """Every association the product offers, its default first, and the textbook's tracker."""
    default = Config().association
    offered = get_args(Config.model_fields["association"].annotation)
    return (default, *(name for name in offered if name != default), REFERENCE)


def begin(name: str, config: Config) -> Follow:
    """A fresh tracker.

    Args:
        name: One of `contestants`.
        config: Everything but the association.
    """
    if name == REFERENCE:
        reference = ReferenceTracker(config)
        return lambda stamp_ns, sensed: reference.step(stamp_ns, as_positions(sensed.measurements))
    tracker = PersonTracker(config.replace(association=name))
    return lambda stamp_ns, sensed: tracker.step(
        stamp_ns, sensed.measurements, view=sensed.view, scan_view=sensed.scan_view
    )


def paired_interval(difference: np.ndarray, rng: np.random.Generator) -> tuple[float, float]:
    """95 % bootstrap interval of the mean; NaN at both ends where there is nothing to compare."""
    difference = difference[np.isfinite(difference)]
    if len(difference) == 0:
        return float("nan"), float("nan")
    means = rng.choice(difference, (4000, len(difference))).mean(axis=1)
    low, high = np.quantile(means, [0.025, 0.975])
    return float(low), float(high)
