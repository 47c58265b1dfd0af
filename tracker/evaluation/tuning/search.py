"""Which parameters are best for a scenario or a recording? A search that can be continued.

Optuna's tree-structured Parzen estimator proposes, every trial sees the same scenes, and what has
been tried lies in Optuna's storage: several processes share it, and a later call goes on in it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_EXCEPTION, Executor, wait
from contextlib import contextmanager
from importlib import import_module
from itertools import count
from signal import SIG_IGN, SIGINT, signal
from types import ModuleType
from typing import TYPE_CHECKING, Any
from warnings import catch_warnings, simplefilter

import numpy as np

from tracker.config import Config
from tracker.errors import ConfigError, RecordingError
from tracker.evaluation.tuning.objective import Objective
from tracker.evaluation.tuning.result import Tuning
from tracker.evaluation.tuning.space import suggest, within_search

if TYPE_CHECKING:
    from optuna import Study, Trial
    from optuna.trial import FrozenTrial

#: Told how many trials are done, and the best figure so far (NaN before there is one).
Progress = Callable[[int, float], None]

#: Told how many unseen scenes the verdict has seen; 0 as it begins.
Judged = Callable[[int], None]

#: Trials drawn at random before the estimator begins, and before any is cut short.
_BEGINNING = 10
_POLL_S = 0.5


def tune(
    objective: Objective,
    names: Sequence[str],
    base: Config,
    *,
    trials: int,
    storage: str,
    seed: int = 1,
    jobs: int = 1,
    executor: Executor | None = None,
    progress: Progress = lambda done, best: None,
    judged: Judged = lambda scenes: None,
) -> Tuning:
    """Search for this many trials, then test the best on data that no trial has used.

    The first trial is `base` itself. Run again with the same storage, it goes on where it was; so
    it does after an interruption.

    Args:
        objective: What is better.
        names: Parameters to search, from `choose_parameters`.
        base: All other parameters, and what the best is held against.
        trials: How many in all, earlier ones included.
        storage: An Optuna storage, such as sqlite:///tuning.db.
        seed: Of the search; one process gives the same trials again.
        jobs: Shares into which the trials are cut for the executor.
        executor: Who runs them, and the verdict; here and now where None.
        progress: Told how far it is.
        judged: Told how far the verdict is.

    Raises:
        ConfigError: Optuna is not there, the storage is unknown or holds another search, or the
            objective cannot judge a parameter.
        RecordingError: The storage cannot be read or written.
    """
    if not names or trials < 1:
        raise ConfigError(
            f"{trials} trials of {len(names)} parameters were asked for; one of each is needed."
        )
    objective.check(names)
    with _storage_errors(storage):
        study = _search_all(
            objective, names, base, trials, storage, seed, jobs, executor, progress
        )
        return _verdict(objective, names, base, study, executor, judged)


def _search_all(
    objective: Objective,
    names: Sequence[str],
    base: Config,
    trials: int,
    storage: str,
    seed: int,
    jobs: int,
    executor: Executor | None,
    progress: Progress,
) -> Study:
    study = _open(objective, names, base, storage)
    done, _ = _standing(study)
    study.set_user_attr("is_stopped", False)
    first = {name: getattr(base, name) for name in names} if done == 0 else {}
    first = {name: value for name, value in first.items() if within_search(name, value)}
    shares = [len(part) for part in np.array_split(np.arange(max(trials - done, 0)), jobs)]
    work = [
        (
            objective,
            tuple(names),
            base,
            storage,
            share,
            (seed, done, worker),
            first if worker == 0 else {},
        )
        for worker, share in enumerate(shares)
        if share
    ]
    if executor is None:
        for item in work:
            _search(*item, progress=progress)
    else:
        _share_out(executor, work, study, progress)
    return study


def _open(objective: Objective, names: Sequence[str], base: Config, storage: str) -> Study:
    """The study in the storage, or a new one."""
    optuna = _optuna()
    study = _load(optuna, storage, objective)
    problem = {
        "objective": objective.describe(),
        "searched": list(names),
        "base": base.model_dump(),
    }
    before = study.user_attrs.get("problem")
    if before is None:
        study.set_user_attr("problem", problem)
    elif before != problem:
        other = ", ".join(key for key in problem if before.get(key) != problem[key])
        raise ConfigError(
            f"{storage}: holds a search with another {other}, so the figures cannot be compared; "
            "give another --storage or --out, or the same arguments as before."
        )
    return study


def _load(optuna: ModuleType, storage: str, objective: Objective) -> Study:
    study: Study = optuna.create_study(
        storage=_opened(optuna, storage),
        study_name=objective.name,
        direction="minimize" if objective.is_cost else "maximize",
        load_if_exists=True,
    )
    return study


def _opened(optuna: ModuleType, storage: str) -> Any:
    from sqlalchemy.exc import ArgumentError, NoSuchModuleError

    try:
        return optuna.storages.get_storage(storage)
    except (ValueError, ImportError, ArgumentError, NoSuchModuleError) as error:
        raise ConfigError(
            f"--storage {storage}: cannot be used ({_reason(error)}); expected an address of a "
            "database, such as sqlite:///tuning.db."
        ) from error


@contextmanager
def _storage_errors(storage: str) -> Iterator[None]:
    """What goes wrong with a database, at any time: it is full, gone, broken, or another's."""
    optuna = _optuna()
    from sqlalchemy.exc import SQLAlchemyError

    try:
        yield
    except (optuna.exceptions.StorageInternalError, SQLAlchemyError) as error:
        raise RecordingError(
            f"--storage {storage}: cannot be read or written ({_reason(error)}); check it, or "
            "give another --storage or --out."
        ) from error


def _reason(error: BaseException) -> str:
    """The first line of the error from which another one came."""
    while error.__cause__ is not None:
        error = error.__cause__
    lines = str(getattr(error, "orig", None) or error).strip().splitlines()
    return lines[0].rstrip(".") if lines else type(error).__name__


def _search(
    objective: Objective,
    names: tuple[str, ...],
    base: Config,
    storage: str,
    trials: int,
    seeds: tuple[int, ...],
    first: Mapping[str, Any],
    progress: Progress = lambda done, best: None,
) -> None:
    """One process's share of the trials; what the first one of them tries may be given."""
    optuna = _optuna()
    study = _load(optuna, storage, objective)
    with catch_warnings():
        simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
        sampler = optuna.samplers.TPESampler(
            n_startup_trials=_BEGINNING,
            multivariate=True,
            constant_liar=True,
            seed=int(np.random.SeedSequence(seeds).generate_state(1)[0]),
        )
        # Not by Optuna's queue of trials: from SQLite two processes may take the same one.
        given = optuna.samplers.PartialFixedSampler(dict(first), sampler)
    study.pruner = optuna.pruners.MedianPruner(n_startup_trials=_BEGINNING, n_warmup_steps=1)

    def try_one(trial: Trial) -> float:
        try:
            config = base.replace(**suggest(trial, names))
        except ConfigError as error:  # two parameters that contradict each other
            raise optuna.TrialPruned(str(error)) from error
        found: list[float] = []
        for part, value in enumerate(objective.seen(config)):
            found.append(value)
            trial.report(float(np.mean(found)), part)
            if part + 1 < objective.parts and trial.should_prune():
                raise optuna.TrialPruned("worse than most after the first scenes")
        return float(np.mean(found))

    def after(study: Study, trial: FrozenTrial) -> None:
        progress(*_standing(study))
        if study.user_attrs.get("is_stopped"):
            study.stop()

    if first:
        study.sampler = given
        study.optimize(try_one, n_trials=1, callbacks=[after])
        trials -= 1
        if study.user_attrs.get("is_stopped"):
            return
    study.sampler = sampler
    study.optimize(try_one, n_trials=trials, callbacks=[after])


def _share_out(
    executor: Executor, work: list[tuple[Any, ...]], study: Study, progress: Progress
) -> None:
    futures = [executor.submit(_search_on, *item) for item in work]
    try:
        left = set(futures)
        while left:
            done, left = wait(left, _POLL_S, FIRST_EXCEPTION)
            for future in done:
                future.result()
            progress(*_standing(study))
    finally:
        study.set_user_attr("is_stopped", True)  # whoever still searches ends with this trial


def _search_on(*item: Any) -> None:
    """In another process: the main process handles Ctrl-C; this one ends after its trial."""
    signal(SIGINT, SIG_IGN)
    _search(*item)


def _verdict(
    objective: Objective,
    names: Sequence[str],
    base: Config,
    study: Study,
    executor: Executor | None,
    judged: Judged,
) -> Tuning:
    complete = [trial for trial in study.trials if trial.state.name == "COMPLETE"]
    if not complete:
        raise ConfigError("No trial was completed; use more --trials.")
    chosen = study.best_trial
    best = base.replace(**chosen.params)
    run = map if executor is None else executor.map
    scenes = count(1)
    judged(0)

    def told(*items: Any) -> Iterator[Any]:
        for value in run(*items):
            judged(next(scenes))
            yield value

    return Tuning(
        source=objective.name,
        figure=objective.figure,
        is_cost=objective.is_cost,
        names=tuple(names),
        base=base,
        best=best,
        best_trial=chosen.number,
        trials=_standing(study)[0],
        number=np.array([trial.number for trial in complete]),
        value=np.array([trial.value for trial in complete], dtype=float),
        tried={name: tuple(trial.params[name] for trial in complete) for name in names},
        importance=_importance(study, names),
        unseen_base=objective.unseen(base, told),
        unseen_best=objective.unseen(best, told),
    )


def _importance(study: Study, names: Sequence[str]) -> dict[str, float]:
    """Share of each parameter in what makes a trial good; nothing where too few were tried."""
    optuna = _optuna()
    evaluator_of = optuna.importance.PedAnovaImportanceEvaluator
    with catch_warnings():
        simplefilter("ignore")  # the evaluator is marked as experimental
        try:
            found = optuna.importance.get_param_importances(study, evaluator=evaluator_of())
        except (RuntimeError, ValueError):
            return {}
    if not np.isfinite(list(found.values())).all():  # all trials alike
        return {}
    return {name: float(found[name]) for name in sorted(found, key=found.get, reverse=True)}


def _standing(study: Study) -> tuple[int, float]:
    """How many trials are done, and the best figure; NaN where there is none."""
    ended = study.get_trials(deepcopy=False, states=_ended())
    values = [float(trial.value) for trial in ended if trial.state.name == "COMPLETE"]
    pick = min if study.direction.name == "MINIMIZE" else max
    return len(ended), pick(values, default=float("nan"))


def _ended() -> tuple[Any, ...]:
    """States of trials that count: those that came to their end, and those cut short."""
    states = _optuna().trial.TrialState
    return states.COMPLETE, states.PRUNED


def check_optuna() -> None:
    """Check, before any long work, that a search can begin.

    Raises:
        ConfigError: Optuna is not installed.
    """
    _optuna()


def _optuna() -> ModuleType:
    try:
        optuna = import_module("optuna")
    except ImportError as error:
        raise ConfigError(
            "Tuning needs Optuna, which is not installed; run "
            "`pip install '.[tune]'` in the project's folder."
        ) from error
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    return optuna
