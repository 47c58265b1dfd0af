"""Run many trials of a scenario: the unit of work is (scenario, configuration, seed, trials).

A unit is a picklable call that any `concurrent.futures` executor runs: threads, processes, or a
cluster's. What comes out does not depend on who ran what when: units are cut the same way always,
each trial has its own generator, and sums are formed in the order of the trials.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass, field

import numpy as np

from tracker.config import Config
from tracker.containers import FloatArray
from tracker.errors import ConfigError, SceneError
from tracker.evaluation.cramer_rao import posterior_bound
from tracker.evaluation.filter_study import filter_errors, prior_covariance
from tracker.evaluation.known_people import known_people_rows
from tracker.evaluation.people_trial import people_trial
from tracker.evaluation.scan_trial import scan_trial
from tracker.evaluation.scenario import (
    SCENARIOS,
    FilterScenario,
    KnownPeopleScenario,
    PeopleScenario,
    Scenario,
    default_config,
)
from tracker.evaluation.study import (
    FilterStudy,
    KnownPeopleStudy,
    PeopleStudy,
    Study,
    settled_frame,
)

#: Trials of one unit of work: enough to be worth sending, few enough to fit into a cache.
_BATCH_UNIT, _PEOPLE_UNIT = 250, 2


@dataclass(frozen=True, slots=True, eq=False)
class Unit:
    """What one unit of work gives.

    Attributes:
        rows: Figures of each trial, shape (B,).
        sums: Of a filter scenario, over the trials: arrays of shape (T, ...).
    """

    rows: dict[str, FloatArray]
    sums: dict[str, FloatArray] = field(default_factory=dict)


def run_unit(scenario: Scenario, config: Config, seed: int, first: int, count: int) -> Unit:
    """Run some trials of a scenario.

    Args:
        scenario: What happens.
        config: The tracker's parameters.
        seed: Of the study.
        first: Number of the first trial.
        count: How many.

    Raises:
        SceneError: The recording of paths cannot be used.
    """
    if isinstance(scenario, FilterScenario):
        return _filter_unit(scenario, config, seed, first, count)
    if isinstance(scenario, KnownPeopleScenario):
        return Unit(known_people_rows(scenario, config, seed, first, count))
    numbers = range(first, first + count)
    if isinstance(scenario, PeopleScenario):
        trials = [people_trial(scenario, config, seed, trial) for trial in numbers]
    else:
        trials = [scan_trial(scenario, config, seed, trial) for trial in numbers]
    return Unit({name: np.array([row[name] for row in trials]) for name in trials[0]})


def monte_carlo(
    scenario: str | Scenario,
    trials: int,
    seed: int = 1,
    config: Config | None = None,
    *,
    executor: Executor | None = None,
    progress: Callable[[float], None] = lambda share: None,
) -> Study:
    """Run a study.

    Args:
        scenario: A name from `SCENARIOS`, or one of your own.
        trials: How many.
        seed: Trial i of a seed is the same in every study.
        config: The tracker's parameters; the scenario's own where None.
        executor: Who runs the units; here and now where None.
        progress: Told the share that is done.

    Raises:
        SceneError: No scenario has this name, or its recording of paths cannot be used.
        ConfigError: There are no trials, or the seed is negative.
    """
    if trials < 1 or seed < 0:
        raise ConfigError(
            f"{trials} trials of seed {seed} were asked for; needed are a trial and a seed from 0."
        )
    name, scenario = find_scenario(scenario)
    config = default_config(scenario) if config is None else config
    is_batch = isinstance(scenario, (FilterScenario, KnownPeopleScenario))
    size = _BATCH_UNIT if is_batch else _PEOPLE_UNIT
    starts = range(0, trials, size)
    arguments = [(scenario, config, seed, first, min(size, trials - first)) for first in starts]
    units = []
    for unit in _run(arguments, executor):
        units.append(unit)
        progress(len(units) / len(arguments))
    rows = {key: np.concatenate([unit.rows[key] for unit in units]) for key in units[0].rows}
    if isinstance(scenario, KnownPeopleScenario):
        return KnownPeopleStudy(name, scenario, config, seed, rows)
    if not isinstance(scenario, FilterScenario):
        return PeopleStudy(name, scenario, config, seed, rows)
    means = {
        key: np.sum([unit.sums[key] for unit in units], axis=0) / trials for key in units[0].sums
    }
    return FilterStudy(name, scenario, config, seed, rows, **means)


def find_scenario(scenario: str | Scenario) -> tuple[str, Scenario]:
    """A scenario and its name.

    Raises:
        SceneError: No scenario has this name; the message lists those there are.
    """
    if not isinstance(scenario, str):
        return "own", scenario
    if scenario not in SCENARIOS:
        raise SceneError(f"There is no scenario {scenario!r}; there are {', '.join(SCENARIOS)}.")
    return scenario, SCENARIOS[scenario]


def _run(
    arguments: list[tuple[Scenario, Config, int, int, int]], executor: Executor | None
) -> Iterator[Unit]:
    if executor is None:
        yield from (run_unit(*item) for item in arguments)
        return
    futures = [executor.submit(run_unit, *item) for item in arguments]
    try:
        for future in futures:  # in order, so that sums do not depend on who is faster
            yield future.result()
    finally:
        for future in futures:
            future.cancel()


def _filter_unit(
    scenario: FilterScenario, config: Config, seed: int, first: int, count: int
) -> Unit:
    errors = filter_errors(scenario, config, seed, first, count)
    settled = settled_frame(scenario)
    bound = posterior_bound(
        prior_covariance(scenario),
        errors.information,
        1.0 / scenario.rate_hz,
        scenario.acceleration_density,
    )
    bound_m2 = bound[settled:, :, 0, 0] + bound[settled:, :, 1, 1]
    return Unit(
        rows={
            "mse_m2": errors.squared_error_m2[settled:].mean(axis=0),
            "bound_m2": bound_m2.mean(axis=0),
            "final_error_m": np.sqrt(errors.squared_error_m2[-1]),
            "final_nees": errors.nees[-1],
            "mean_nees": errors.nees[settled:].mean(axis=0),
        },
        sums={
            "squared_error_m2": errors.squared_error_m2.sum(axis=1),
            "nees": errors.nees.sum(axis=1),
            "information": errors.information.sum(axis=1),
        },
    )
