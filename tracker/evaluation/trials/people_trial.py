"""One trial of the whole tracker: a scene, its measurements, the tracks, and how good they are."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tracker.config import Config
from tracker.containers import FrameResult, Hands, Measurements, Tracks, Truth
from tracker.evaluation.metrics.consistency import normalized_squared
from tracker.evaluation.metrics.episodes import EpisodeEvaluation
from tracker.evaluation.metrics.gospa import gospa
from tracker.evaluation.metrics.identity import identity_switches, track_purity
from tracker.evaluation.metrics.matching import Matcher
from tracker.evaluation.metrics.ospa import ospa
from tracker.evaluation.metrics.raises import count_raises
from tracker.evaluation.recordings.tracker_steps import Step, run_steps
from tracker.evaluation.trials.people_scene import draw_scene
from tracker.evaluation.trials.people_sensing import Sensed, sense
from tracker.evaluation.trials.scenario import PeopleScenario
from tracker.evaluation.trials.stated_noise import restate
from tracker.evaluation.trials.trial_seed import trial_rng

CUTOFF_M = 1.0


class TrialScores:
    """Gathers one trial's figures, frame by frame, of whichever tracker.

    Only people whose hand has been up count: before, nobody could know them.

    Args:
        config: The streaks, for what counts as a missed raise.
    """

    def __init__(self, config: Config) -> None:
        self._matcher = Matcher(CUTOFF_M)
        self._episodes = EpisodeEvaluation(
            cutoff_m=CUTOFF_M,
            raise_streak=config.raise_streak,
            lower_streak=config.lower_streak,
        )
        self._called: set[int] = set()
        self._sets: list[tuple[float, ...]] = []
        self._persons: list[np.ndarray] = []
        self._tracks: list[np.ndarray] = []
        self._nees: list[np.ndarray] = []
        self._squared: list[np.ndarray] = []
        self._stamps: list[int] = []

    def add(self, truth: Truth, tracks: Tracks) -> None:
        """Compare one frame.

        Args:
            truth: Everybody who is there.
            tracks: Everybody whom the tracker knows; tentative ones do not count.
        """
        tracks = tracks[tracks.confirmed]
        self._stamps.append(truth.stamp_ns)
        self._called.update(truth.id[truth.hand_up & truth.in_view].tolist())
        counts = np.isin(truth.id, list(self._called))
        person, people_xy = truth.id[counts], truth.xy_m[counts]
        tracks_xy = tracks.mean[:, :2]
        parts = gospa(tracks_xy, people_xy, CUTOFF_M)
        self._sets.append(
            (
                parts.distance_m,
                parts.localisation,
                parts.missed,
                parts.false,
                ospa(tracks_xy, people_xy, CUTOFF_M),
                2.0 * parts.missed / CUTOFF_M**2,
                2.0 * parts.false / CUTOFF_M**2,
                float(len(person)),
            )
        )
        rows, columns = self._matcher.match(tracks.id, tracks_xy, person, people_xy)
        error = people_xy[columns] - tracks_xy[rows]
        self._persons.append(person[columns])
        self._tracks.append(tracks.id[rows])
        self._squared.append((error**2).sum(axis=-1))
        self._nees.append(normalized_squared(error, tracks.covariance[rows, :2, :2]))
        self._episodes.add_truth(truth)
        self._episodes.add_result(_result(tracks))

    def row(self) -> dict[str, float]:
        """The trial's figures; means over its frames, NaN where there was nothing to measure."""
        sets = np.array(self._sets)
        person, track = np.concatenate(self._persons), np.concatenate(self._tracks)
        frames_s = (self._stamps[-1] - self._stamps[0]) / 1e9 / max(len(self._stamps) - 1, 1)
        seconds = frames_s * len(self._stamps)
        raises = count_raises(self._episodes.report())
        people_frames = sets[:, 7].sum()
        return {
            "gospa_m": float(sets[:, 0].mean()),
            "gospa_localisation": float(sets[:, 1].mean()),
            "gospa_missed": float(sets[:, 2].mean()),
            "gospa_false": float(sets[:, 3].mean()),
            "ospa_m": float(sets[:, 4].mean()),
            "missed_share": float(sets[:, 5].sum() / people_frames) if people_frames else np.nan,
            "false_tracks": float(sets[:, 6].mean()),
            "identity_switches_per_min": identity_switches(person, track) / (seconds / 60.0),
            "track_purity": track_purity(person, track),
            "rmse_m": float(np.sqrt(_mean(self._squared))),
            "nees_position": _mean(self._nees),
            "time_to_raise_s": float(np.mean(raises.delays_s)) if raises.delays_s else np.nan,
            "hands": float(raises.hands),
            "missed_raises": float(raises.missed),
            "false_raises": float(raises.false),
            "raised_again": float(raises.again),
            "same_identity": float(raises.same),
            "wrong_identity": float(raises.wrong),
        }


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
    rng = trial_rng(seed, trial)
    scene = draw_scene(scenario, rng)
    return [
        (scene.truth(frame), sensed) for frame, sensed in enumerate(sense(scenario, scene, rng))
    ]


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
        The row of `TrialScores`.

    Raises:
        SceneError: The recording of paths cannot be used.
    """
    frames = draw_people_trial(scenario, seed, trial)
    scores = TrialScores(config)
    tracks = run_steps(_steps(scenario, frames, config), config)
    for (truth, _), those in zip(frames, tracks, strict=True):
        scores.add(truth, those)
    return scores.row()


def people_steps(
    scenario: PeopleScenario, config: Config, seed: int, trial: int
) -> tuple[Step, ...]:
    """What one trial gives the tracker; see `people_trial`."""
    return tuple(_steps(scenario, draw_people_trial(scenario, seed, trial), config))


def _steps(
    scenario: PeopleScenario, frames: list[tuple[Truth, Sensed]], config: Config
) -> Iterator[Step]:
    for truth, sensed in frames:
        measurements = sensed.measurements
        if not scenario.noise_known:
            measurements = restate(measurements, config, scenario.hand_offset_m)
        x_m, y_m = sensed.view.sensor_pose[:2].tolist()
        yield Step(truth.stamp_ns, measurements, (x_m, y_m), sensed.view, sensed.scan_view)


def _mean(parts: list[np.ndarray]) -> float:
    values = np.concatenate(parts)
    return float(values.mean()) if len(values) else float("nan")


def _result(tracks: Tracks) -> FrameResult:
    """The little of a frame's result that the episodes look at."""
    return FrameResult(
        stamp_ns=tracks.stamp_ns,
        hands=Hands.none(),
        measurements=Measurements.none(),
        tracks=tracks,
        hand_raised=bool(tracks.raised.any()),
        customer_pose=None,
        approach_pose=None,
        sensor_pose=None,
        scan=None,
    )
