"""One trial of the whole tracker: a scene, its measurements, the tracks, and how good they are."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from tracker.config import Config
from tracker.containers import Truth
from tracker.evaluation.metrics.scores import score_trial
from tracker.evaluation.recordings.tracker_steps import Step
from tracker.evaluation.trials.people_scene import PeopleScene, draw_scene
from tracker.evaluation.trials.people_sensing import Sensed, SensedFrames, sense
from tracker.evaluation.trials.scenario import PeopleScenario
from tracker.evaluation.trials.stated_noise import restate
from tracker.evaluation.trials.trial_loop import track_sensed
from tracker.evaluation.trials.trial_seed import trial_rng


def draw_people_trial(
    scenario: PeopleScenario, seed: int, trial: int
) -> list[tuple[Truth, Sensed]]:
    """What is true and what is measured, frame by frame.

    Args:
        scenario: People, sensors, faults.
        seed: Of the study.
        trial: From 0.

    Raises:
        SceneError: The recording of paths cannot be used.
    """
    scene, sensed = _draw(scenario, seed, trial)
    return list(zip(scene.truth, sensed, strict=True))


def people_trial(
    scenario: PeopleScenario, config: Config, seed: int, trial: int
) -> dict[str, float]:
    """Run one trial through a tracker of its own.

    Args:
        scenario: People, sensors, faults.
        config: The tracker's parameters.
        seed: Of the study.
        trial: From 0.

    Returns:
        The figures of `metrics.scores.score_trial`.

    Raises:
        SceneError: The recording of paths cannot be used.
    """
    scene, sensed = _draw(scenario, seed, trial)
    sensed = _stated(scenario, sensed, config)
    tracks = track_sensed(scene.truth.stamps_ns, sensed, config)
    return score_trial(scene.truth, tracks, config)


def people_steps(
    scenario: PeopleScenario, config: Config, seed: int, trial: int
) -> tuple[Step, ...]:
    """What one trial gives the tracker; see `people_trial`."""
    scene, sensed = _draw(scenario, seed, trial)
    return tuple(_steps(scene, _stated(scenario, sensed, config)))


def _draw(scenario: PeopleScenario, seed: int, trial: int) -> tuple[PeopleScene, SensedFrames]:
    rng = trial_rng(seed, trial)
    scene = draw_scene(scenario, rng)
    return scene, sense(scenario, scene, rng)


def _stated(scenario: PeopleScenario, sensed: SensedFrames, config: Config) -> SensedFrames:
    """The noise as the measurements' source would state it."""
    if scenario.noise_known:
        return sensed
    told = restate(sensed.measurements, config, scenario.hand_offset_m)
    return replace(sensed, measurements=told)


def _steps(scene: PeopleScene, sensed: SensedFrames) -> Iterator[Step]:
    for stamp_ns, frame in zip(scene.truth.stamps_ns.tolist(), sensed, strict=True):
        x_m, y_m = frame.view.sensor_pose[:2].tolist()
        yield Step(stamp_ns, frame.measurements, (x_m, y_m), frame.view, frame.scan_view)
