"""The trackers that benchmarks compare, by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias, get_args

from tracker import Config, PersonTracker, Tracks
from tracker.containers.as_positions import as_positions
from tracker.evaluation.trials.people_sensing import Sensed
from tracker.tracking.reference import ReferenceTracker

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
