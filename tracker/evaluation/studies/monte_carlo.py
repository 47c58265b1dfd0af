"""Run many trials of a scenario: the unit of work is (scenario, configuration, seed, trials).

A unit is a picklable call that any `concurrent.futures` executor runs: threads, processes, or a
cluster's. What comes out does not depend on who ran what when, nor on whether the study was
stopped in between: units are cut the same way always, each trial has its own generator, and sums
are formed in the order of the trials.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from concurrent.futures import Executor
from contextlib import ExitStack, closing
from dataclasses import asdict
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from tracker.config import Config
from tracker.errors import ConfigError, SceneError
from tracker.evaluation.metrics.cramer_rao import posterior_bound
from tracker.evaluation.studies.study import (
    FilterStudy,
    KnownPeopleStudy,
    PeopleStudy,
    Study,
    settled_frame,
)
from tracker.evaluation.studies.study_log import StudyLog
from tracker.evaluation.studies.unit import Gathered, Unit
from tracker.evaluation.studies.workers import run_in_order
from tracker.evaluation.trials.filter_study import filter_errors, prior_covariance
from tracker.evaluation.trials.known_people import known_people_rows
from tracker.evaluation.trials.people_trial import people_trial
from tracker.evaluation.trials.scan_trial import scan_trial
from tracker.evaluation.trials.scenario import (
    SCENARIOS,
    FilterScenario,
    KnownPeopleScenario,
    PeopleScenario,
    ScanScenario,
    Scenario,
    default_config,
)

#: Trials of one unit of work, enough to be worth sending, and how many units a process must get to
#: make up for its start of a second or two.
_UNITS: dict[type[Scenario], tuple[int, int]] = {
    FilterScenario: (250, 50),
    KnownPeopleScenario: (250, 50),
    PeopleScenario: (50, 4),
    ScanScenario: (2, 1),
}


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
    folder: str | Path | None = None,
) -> Study:
    """Run a study, or the rest of one that was stopped.

    Args:
        scenario: A name from `SCENARIOS`, or one of your own.
        trials: How many.
        seed: Trial i of a seed is the same in every study.
        config: The tracker's parameters; the scenario's own where None.
        executor: Who runs the units; here and now where None.
        progress: Told the share that is done.
        folder: Rows are written there as units finish (`study_log.StudyLog`); what is there of
            this very study is not run again.

    Raises:
        SceneError: No scenario has this name, or its recording of paths cannot be used.
        ConfigError: There are no trials, the seed is negative, the folder holds another study, or
            somebody else writes there.
        RecordingError: The folder cannot be read or written.
        WorkerError: The executor's workers die again and again.
    """
    if trials < 1 or seed < 0:
        raise ConfigError(
            f"{trials} trials of seed {seed} were asked for; expected a trial and a seed from 0."
        )
    name, scenario = find_scenario(scenario)
    config = default_config(scenario) if config is None else config
    size, _ = _UNITS[type(scenario)]
    gathered, done, log = Gathered(), 0, None
    with ExitStack() as opened:
        if folder is not None:
            settings = _settings(scenario, config, seed)
            shapes = _shapes_of_sums(scenario)
            log = opened.enter_context(StudyLog(folder, settings, size, shapes))
            for unit in log.units(trials):
                gathered.add(unit)
                done += 1
        progress(min(done * size, trials) / trials)
        calls = (
            partial(run_unit, scenario, config, seed, first, min(size, trials - first))
            for first in range(done * size, trials, size)
        )
        units = opened.enter_context(closing(run_in_order(calls, executor)))
        for number, unit in enumerate(units, start=done):
            gathered.add(unit)
            if log is not None:
                log.add(number, unit)
            progress(min((number + 1) * size, trials) / trials)
    rows = gathered.rows()
    if isinstance(scenario, KnownPeopleScenario):
        return KnownPeopleStudy(name, scenario, config, seed, rows)
    if not isinstance(scenario, FilterScenario):
        return PeopleStudy(name, scenario, config, seed, rows)
    return FilterStudy(name, scenario, config, seed, rows, **gathered.means(trials))


def worthwhile_workers(scenario: Scenario, trials: int) -> int:
    """More processes than that would take longer to start than they save."""
    size, worthwhile = _UNITS[type(scenario)]
    return -(-trials // size) // worthwhile


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


def _settings(scenario: Scenario, config: Config, seed: int) -> dict[str, Any]:
    """Everything on which the rows depend, in plain values."""
    settings = {
        "version": version("raised-hand-tracker"),
        "seed": seed,
        "scenario": asdict(scenario),
        "config": config.model_dump(),
    }
    return dict(json.loads(json.dumps(settings)))  # lists for tuples


def _shapes_of_sums(scenario: Scenario) -> dict[str, tuple[int, ...]]:
    if not isinstance(scenario, FilterScenario):
        return {}
    frames = scenario.frames
    return {
        "squared_error_m2": (frames,),
        "nees": (frames,),
        "information": (frames, 2, 2),
    }


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
