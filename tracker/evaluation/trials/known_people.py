"""People known from the start: association only, and what its mistakes cost.

Everybody moves at nearly constant velocity, as the tracker believes. All trials of a unit go
through one loop: a million frames of five people take seconds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.config import Config
from tracker.containers import FloatArray, IntArray
from tracker.evaluation.metrics.consistency import normalized_squared
from tracker.evaluation.metrics.constant_velocity import process_noise
from tracker.evaluation.metrics.matching import distances, match_best
from tracker.evaluation.trials.known_people_loop import follow
from tracker.evaluation.trials.scenario import KnownPeopleScenario
from tracker.evaluation.trials.trial_seed import trial_rng

#: A track this far from everybody stands for nobody.
_CUTOFF_M = 1.0


@dataclass(frozen=True, slots=True, eq=False)
class KnownPeopleTrials:
    """What was drawn: N people in each of B trials, over T frames.

    Attributes:
        prior_mean: Shape (B, N, 4): what the tracker is told at the beginning.
        prior_covariance: Shape (B, N, 4, 4).
        truth: Shape (B, T, N, 4).
        values: Shape (B, T, M, 2): bearing_rad and range_m from the origin; row i < N is person
            i's, the others are clutter; NaN where there is nothing.
    """

    prior_mean: FloatArray
    prior_covariance: FloatArray
    truth: FloatArray
    values: FloatArray


def draw_known_people(
    scenario: KnownPeopleScenario, seed: int, first: int, count: int
) -> KnownPeopleTrials:
    """Draw what happens and what is measured; each trial from its own generator.

    Args:
        scenario: People and noise.
        seed: Of the study.
        first: Number of the first trial.
        count: How many.
    """
    frames, people = scenario.frames, scenario.people
    lower, upper = np.array(scenario.area_m[0::2]), np.array(scenario.area_m[1::2])
    prior_mean = np.zeros((count, people, 4))
    walk = np.empty((count, frames + 1, 4, people))
    noise = np.empty((count, frames, 2, people))
    is_seen = np.empty((count, frames, people), dtype=bool)
    clutter: list[tuple[IntArray, FloatArray]] = []  # of each trial: how many a frame; x, y
    for trial in range(count):
        rng = trial_rng(seed, first + trial)
        prior_mean[trial, :, :2] = rng.uniform(lower, upper, (people, 2))
        walk[trial] = rng.standard_normal(walk.shape[1:])
        noise[trial] = rng.standard_normal(noise.shape[1:])
        is_seen[trial] = rng.random(is_seen.shape[1:]) < scenario.detection_probability
        counts = rng.poisson(scenario.clutter_per_frame, frames)
        clutter.append((counts, rng.uniform(lower, upper, (counts.sum(), 2))))

    truth, prior_covariance = _walk(scenario, prior_mean, np.moveaxis(walk, 2, 3))
    longest = max(int(counts.max()) for counts, _ in clutter)
    xy = np.full((count, frames, people + longest, 2), np.nan)
    xy[:, :, :people] = np.where(is_seen[..., None], truth[..., :2], np.nan)
    for trial, (counts, places) in enumerate(clutter):
        xy[trial, :, people:][np.arange(longest) < counts[:, None]] = places
    values = np.stack([np.arctan2(xy[..., 1], xy[..., 0]), np.hypot(xy[..., 0], xy[..., 1])], -1)
    std = np.array([np.deg2rad(scenario.bearing_std_deg), scenario.range_std_m])
    values[:, :, :people] += std * np.moveaxis(noise, 2, 3)
    values[..., 1] = np.maximum(values[..., 1], 0.0)
    return KnownPeopleTrials(prior_mean, prior_covariance, truth, values)


def _walk(
    scenario: KnownPeopleScenario, prior_mean: FloatArray, normal: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Where everybody goes, (B, T, N, 4), from normal numbers of shape (B, T + 1, N, 4).

    The second array, (B, N, 4, 4), is how well the beginning is known.
    """
    dt_s = 1.0 / scenario.rate_hz
    std = np.repeat([scenario.start_std_m, scenario.speed_std_mps], 2)
    state = prior_mean + std * normal[:, 0]
    root = np.linalg.cholesky(process_noise(dt_s, scenario.acceleration_density))
    truth = np.empty((len(normal), scenario.frames, *state.shape[1:]))
    for frame in range(scenario.frames):
        state = state.copy()
        state[..., :2] += dt_s * state[..., 2:]
        # Number by number: the last bit of a matrix product would depend on how many trials.
        state += (normal[:, frame + 1, :, None, :] * root).sum(axis=-1)
        truth[:, frame] = state
    return truth, np.diag(std**2) + np.zeros((*prior_mean.shape, 1))


def known_people_rows(
    scenario: KnownPeopleScenario, config: Config, seed: int, first: int, count: int
) -> dict[str, FloatArray]:
    """Run trials, all at once.

    Args:
        scenario: What happens.
        config: The tracker's parameters.
        seed: Of the study.
        first: Number of the first trial.
        count: B.

    Returns:
        Figures of each trial, shape (B,): `mse_m2`, over all people and frames; `wrong_share` of
        the measurements that were taken, being somebody else's or nobody's; at the last frame
        `swapped_share` and `lost_share` of the people, and `final_nees` of those who are neither
        (NaN for nobody).
    """
    trials = draw_known_people(scenario, seed, first, count)
    followed = follow(
        trials.prior_mean,
        trials.prior_covariance,
        trials.values,
        (float(np.deg2rad(scenario.bearing_std_deg)), scenario.range_std_m),
        1.0 / scenario.rate_hz,
        config,
    )
    squared_m2 = ((followed.mean[..., :2] - trials.truth[..., :2]) ** 2).sum(axis=-1)
    is_taken = followed.row >= 0
    is_wrong = is_taken & (followed.row != np.arange(scenario.people))
    mean, truth = followed.mean[:, -1], trials.truth[:, -1]
    apart_m = distances(mean[..., :2], truth[..., :2])
    stands_for = match_best(_CUTOFF_M**2 - apart_m**2)
    is_found = stands_for[:, np.arange(scenario.people), np.arange(scenario.people)]
    nees = normalized_squared(truth - mean, followed.covariance)
    with np.errstate(invalid="ignore"):
        return {
            "mse_m2": squared_m2.mean(axis=(1, 2)),
            "wrong_share": is_wrong.sum(axis=(1, 2)) / is_taken.sum(axis=(1, 2)),
            "swapped_share": (stands_for.any(axis=1) & ~is_found).mean(axis=1),
            "lost_share": (~stands_for.any(axis=1)).mean(axis=1),
            "final_nees": np.where(is_found, nees, 0.0).sum(axis=1) / is_found.sum(axis=1),
        }
