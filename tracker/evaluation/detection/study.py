"""How many raised hands does a detector find, and how many does it invent? Many scenes, summed up.

A unit of work is a picklable call, as in `monte_carlo`: what comes out does not depend on who runs
it, since each scene has a generator of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

import numpy as np

from tracker.config import Config
from tracker.errors import ConfigError
from tracker.evaluation.detection.episode import (
    FRAMES_TO_FIND,
    CallerScore,
    FalseRaise,
    score_caller,
    score_idlers,
)
from tracker.evaluation.detection.scenes import (
    Conditions,
    caller_scene,
    draw_conditions,
    idlers_scene,
)
from tracker.evaluation.studies.workers import run_in_order
from tracker.evaluation.trials.trial_seed import trial_rng
from tracker.perception import HandDetector

DISTANCES_M = (1.0, 2.0, 3.0, 4.0, 5.0)

OpenDetector: TypeAlias = Callable[[Config], HandDetector]

_Unit: TypeAlias = Callable[[], "list[Episode] | list[Minute]"]
#: Episodes of one unit of work.
_UNIT = 5
_MINUTE_S = 60.0
#: The generators of scenes without callers are numbered from here, apart from the callers'.
_FIRST_MINUTE = 1_000_000


@dataclass(frozen=True, slots=True)
class Episode:
    """One raised hand.

    Attributes:
        number: Of the episode; with the seed it gives the very same scene again.
        conditions: What was balanced.
        style: How the hand was raised.
        posture: `sits` or `stands`.
        score: What became of it.
    """

    number: int
    conditions: Conditions
    style: str
    posture: str
    score: CallerScore


@dataclass(frozen=True, slots=True)
class Minute:
    """One minute in which nobody calls.

    Attributes:
        number: Of the scene; with the seed it gives the very same one again.
        people: What each does, and how far away.
        false_raises: What was invented.
    """

    number: int
    people: tuple[tuple[str, float], ...]
    false_raises: tuple[FalseRaise, ...]


@dataclass(frozen=True, slots=True, eq=False)
class DetectionStudy:
    """What a detector found.

    Attributes:
        seed: Of the study.
        distances_m: Of the callers.
        config: The pipeline's parameters.
        episodes: In order of their numbers.
        minutes: In order of their numbers.
    """

    seed: int
    distances_m: tuple[float, ...]
    config: Config
    episodes: tuple[Episode, ...]
    minutes: tuple[Minute, ...]


def study_detection(
    episodes: int,
    minutes: int,
    seed: int,
    config: Config,
    *,
    distances_m: Sequence[float] = DISTANCES_M,
    open_detector: OpenDetector | None = None,
    executor: Executor | None = None,
    progress: Callable[[float], None] = lambda share: None,
) -> DetectionStudy:
    """Draw scenes, render them, let the pipeline see them, judge it.

    Args:
        episodes: Raised hands, spread evenly over the distances.
        minutes: Minutes of people who do not call.
        seed: Of everything drawn.
        config: The pipeline's parameters; scenes come at its `processing_rate`.
        distances_m: Of the callers; those who do not call are between the least and the greatest.
        open_detector: Makes a detector, in the process where it works; by default the configured
            one.
        executor: Who runs the units; here and now where None.
        progress: Told the share that is done.

    Raises:
        ConfigError: A number is out of range.
        SceneError: At one of the distances no raised hand fits into the picture.
    """
    _check(episodes, minutes, seed, distances_m)
    if open_detector is None:
        from tracker import perception  # brings ONNX Runtime along

        open_detector = perception.open_detector
    distances = tuple(distances_m)
    conditions = draw_conditions(distances, episodes, np.random.default_rng(seed))
    numbered = list(enumerate(conditions))
    units: list[_Unit] = [
        partial(run_minute, number, distances, seed, config, open_detector)
        for number in range(minutes)
    ]
    units += [
        partial(run_episodes, numbered[first : first + _UNIT], seed, config, open_detector)
        for first in range(0, episodes, _UNIT)
    ]
    done: list[Episode | Minute] = []
    for count, results in enumerate(run_in_order(units, executor), start=1):
        done += results
        progress(count / len(units))
    return DetectionStudy(
        seed,
        distances,
        config,
        tuple(item for item in done if isinstance(item, Episode)),
        tuple(item for item in done if isinstance(item, Minute)),
    )


def run_episodes(
    numbered: Sequence[tuple[int, Conditions]],
    seed: int,
    config: Config,
    open_detector: OpenDetector,
) -> list[Episode]:
    """Run some of the episodes, with one detector.

    Args:
        numbered: Number and conditions of each.
        seed: Of the study.
        config: The pipeline's parameters.
        open_detector: Makes the detector.
    """
    detector = open_detector(config)
    rate_hz = config.processing_rate
    episodes = []
    for number, conditions in numbered:
        rng = trial_rng(seed, number)
        scene = caller_scene(conditions, (FRAMES_TO_FIND + 1) / rate_hz, rate_hz, rng)
        caller = scene.people[0]
        posture = "stands" if caller.seat_m is None else "sits"
        score = score_caller(scene, detector, config, rng)
        episodes.append(Episode(number, conditions, caller.raise_style, posture, score))
    return episodes


def run_minute(
    number: int,
    distances_m: Sequence[float],
    seed: int,
    config: Config,
    open_detector: OpenDetector,
) -> list[Minute]:
    """Run one minute in which nobody calls.

    Args:
        number: Of the minute.
        distances_m: The people are between the least and the greatest.
        seed: Of the study.
        config: The pipeline's parameters.
        open_detector: Makes the detector.
    """
    rng = trial_rng(seed, _FIRST_MINUTE + number)
    between_m = (min(distances_m), max(distances_m))
    scene = idlers_scene(number, _MINUTE_S, between_m, config.processing_rate, rng)
    false_raises = score_idlers(scene, open_detector(config), config, rng)
    people = tuple((item.activities[0].what, item.path[0].x_m) for item in scene.people)
    return [Minute(number, people, tuple(false_raises))]


def _check(episodes: int, minutes: int, seed: int, distances_m: Sequence[float]) -> None:
    if episodes < 0 or minutes < 0 or seed < 0 or episodes + minutes == 0:
        raise ConfigError(
            f"{episodes} episodes and {minutes} minutes of seed {seed} were asked for; "
            "expected whole numbers from 0, and at least one episode or minute."
        )
    if not distances_m or not all(0.5 <= distance_m <= 20.0 for distance_m in distances_m):
        raise ConfigError(
            f"The distances are {', '.join(f'{item:g}' for item in distances_m) or 'none'}; "
            "expected meters from 0.5 to 20."
        )
