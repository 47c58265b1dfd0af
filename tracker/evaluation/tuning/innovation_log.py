"""Is the filter as uncertain as its innovations? Collected over a scenario or a recording.

Where the filter is right, its innovations are independent from frame to frame and their NIS is
chi-square: no truth is needed to see that it is not.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from tracker.config import Config
from tracker.errors import ConfigError
from tracker.evaluation.metrics.consistency import mean_bounds
from tracker.evaluation.metrics.innovations import Innovations, innovations_of
from tracker.evaluation.metrics.rounds import rounds_of
from tracker.evaluation.recordings.tracker_steps import Step, run_steps
from tracker.evaluation.trials.people_trial import people_steps
from tracker.evaluation.trials.scenario import PeopleScenario, default_config
from tracker.tracking.trace import Watched


class InnovationLog:
    """A `Watch` that keeps the innovations: `PersonTracker(config, watch=InnovationLog())`."""

    def __init__(self) -> None:
        self._parts: list[Innovations] = []

    def __call__(self, watched: Watched) -> None:
        """Keep a frame's assigned measurements."""
        for round_ in rounds_of(watched):
            if round_.is_chosen.any():
                self._parts.append(innovations_of(round_))

    @property
    def innovations(self) -> Innovations:
        """All so far, in order.

        Raises:
            ConfigError: There are none: no measurement has been assigned to anybody.
        """
        if not self._parts:
            raise ConfigError(
                "No measurement was assigned to anybody; use a scenario or recording in which "
                "people are tracked."
            )
        return Innovations.concatenate(*self._parts)


@dataclass(frozen=True, slots=True)
class Nis:
    """The mean NIS of measurements with as many numbers.

    Attributes:
        dimensions: Degrees of freedom: 2 with a range, 1 for a bearing alone; the ideal mean.
        samples: How many measurements.
        mean: Of their NIS.
        bounds: Between which the mean lies in 95 of 100 cases, if the filter is right.
    """

    dimensions: int
    samples: int
    mean: float
    bounds: tuple[float, float]


def innovations_of_steps(steps: Iterable[Step], config: Config) -> Innovations:
    """Innovations of a recording, from `recorded_steps`, under any parameters.

    Raises:
        ConfigError: Nobody was tracked in it.
    """
    log = InnovationLog()
    for _ in run_steps(steps, config, log):
        pass
    return log.innovations


def innovations_of_scenario(
    scenario: PeopleScenario, trials: int, seed: int = 1, config: Config | None = None
) -> Innovations:
    """Innovations of so many trials, one after the other.

    Args:
        scenario: People, sensors, faults.
        trials: How many.
        seed: Of the study.
        config: The tracker's parameters; the scenario's own where None.

    Raises:
        ConfigError: Nobody was tracked.
    """
    config = default_config(scenario) if config is None else config
    log = InnovationLog()
    for trial in range(trials):
        for _ in run_steps(people_steps(scenario, config, seed, trial), config, log):
            pass
    return log.innovations


def nis_by_dimensions(innovations: Innovations, probability: float = 0.95) -> tuple[Nis, ...]:
    """Mean NIS and its bounds, of pairs of numbers and of bearings alone, where there are any.

    Args:
        innovations: From a log.
        probability: Of lying within the bounds; see `consistency.mean_bounds`.
    """
    found = []
    for dimensions, rows in ((2, innovations.ranged), (1, ~innovations.ranged)):
        nis = innovations.nis[rows]
        if len(nis):
            bounds = mean_bounds(dimensions, len(nis), probability)
            found.append(Nis(dimensions, len(nis), float(np.mean(nis)), bounds))
    return tuple(found)
