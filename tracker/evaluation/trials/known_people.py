"""People who are known from the start: whose measurement is whose, and what do mistakes cost?

All trials of a unit go through `BatchedTracker` at once: a million frames of five people take
seconds. Everybody moves at nearly constant velocity, as the tracker believes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray, FloatArray
from tracker.evaluation.metrics.consistency import normalized_squared
from tracker.evaluation.metrics.constant_velocity import process_noise
from tracker.evaluation.trials.batched_tracker import BatchedTracker, assign_trials
from tracker.evaluation.trials.scenario import KnownPeopleScenario
from tracker.evaluation.trials.trial_seed import trial_rng

#: A track this far from everybody stands for nobody.
_CUTOFF_M = 1.0


@dataclass(frozen=True, slots=True, eq=False)
class KnownPeopleTrials:
    """What was drawn: N people in each of B trials, over T frames.

    Attributes:
        prior_mean: Shape (4, N, B): what the tracker is told at the beginning.
        prior_covariance: Shape (4, 4, N, B).
        truth: Shape (T, 4, N, B).
        bearing_rad: Shape (T, M, B), from the origin: row i < N is person i's, the others are
            clutter; NaN where there is nothing.
        range_m: Shape (T, M, B).
    """

    prior_mean: FloatArray
    prior_covariance: FloatArray
    truth: FloatArray
    bearing_rad: FloatArray
    range_m: FloatArray


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
    frames, people, dt_s = scenario.frames, scenario.people, 1.0 / scenario.rate_hz
    lower, upper = np.array(scenario.area_m[0::2]), np.array(scenario.area_m[1::2])
    places = np.empty((2, people, count))
    walk = np.empty((frames + 1, 4, people, count))
    noise = np.empty((frames, 2, people, count))
    is_seen = np.empty((frames, people, count), dtype=bool)
    clutter: list[FloatArray] = []  # of each trial: frame, row in the frame, x, y
    for trial in range(count):
        rng = trial_rng(seed, first + trial)
        places[..., trial] = rng.uniform(lower, upper, (people, 2)).T
        walk[..., trial] = rng.standard_normal(walk.shape[:-1])
        noise[..., trial] = rng.standard_normal(noise.shape[:-1])
        is_seen[..., trial] = rng.random(is_seen.shape[:-1]) < scenario.detection_probability
        counts = rng.poisson(scenario.clutter_per_frame, frames)
        frame = np.repeat(np.arange(frames), counts)
        row = np.arange(len(frame)) - np.repeat(np.cumsum(counts) - counts, counts)
        clutter.append(np.column_stack([frame, row, rng.uniform(lower, upper, (len(frame), 2))]))

    prior_mean = np.zeros((4, people, count))
    prior_mean[:2] = places
    variances = [scenario.start_std_m**2] * 2 + [scenario.speed_std_mps**2] * 2
    state = prior_mean + np.sqrt(variances)[:, None, None] * walk[0]
    root = np.linalg.cholesky(process_noise(dt_s, scenario.acceleration_density))
    truth = np.empty((frames, 4, people, count))
    for moved, push in zip(truth, walk[1:], strict=True):
        moved[:2], moved[2:] = state[:2] + dt_s * state[2:], state[2:]
        for axis in range(4):
            # Number by number: the last bit of a matrix product would depend on how many trials.
            moved[axis] += (root[axis, :, None, None] * push).sum(axis=0)
        state = moved

    longest = max((int(item[:, 1].max(initial=-1.0)) + 1 for item in clutter), default=0)
    xy = np.full((2, frames, people + longest, count), np.nan)
    xy[:, :, :people] = np.where(is_seen, truth[:, :2].swapaxes(0, 1), np.nan)
    for trial, item in enumerate(clutter):
        frame, row = item[:, :2].astype(np.int64).T
        xy[:, frame, people + row, trial] = item[:, 2:].T
    bearing, range_m = np.arctan2(xy[1], xy[0]), np.hypot(xy[0], xy[1])
    bearing[:, :people] += np.deg2rad(scenario.bearing_std_deg) * noise[:, 0]
    range_m[:, :people] += scenario.range_std_m * noise[:, 1]
    covariance = np.diag(variances)[..., None, None] + np.zeros((people, count))
    return KnownPeopleTrials(prior_mean, covariance, truth, bearing, np.maximum(range_m, 0.0))


def known_people_rows(
    scenario: KnownPeopleScenario,
    config: Config,
    seed: int,
    first: int,
    count: int,
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
    tracker = BatchedTracker(
        trials.prior_mean,
        trials.prior_covariance,
        config,
        float(np.deg2rad(scenario.bearing_std_deg)),
        scenario.range_std_m,
    )
    squared, wrong, taken = np.zeros((3, count))
    is_own = np.eye(trials.bearing_rad.shape[1], scenario.people, dtype=bool)[..., None]
    for frame, truth in enumerate(trials.truth):
        chosen = tracker.step(
            1.0 / scenario.rate_hz, trials.bearing_rad[frame], trials.range_m[frame]
        )
        squared += ((tracker.mean[:2] - truth[:2]) ** 2).sum(axis=0).mean(axis=0)
        taken += np.count_nonzero(chosen, axis=(0, 1))
        wrong += np.count_nonzero(chosen & ~is_own, axis=(0, 1))
    stands_for = _stands_for(tracker.mean, trials.truth[-1])
    is_found = stands_for[np.arange(scenario.people), np.arange(scenario.people)]
    error = np.moveaxis(trials.truth[-1] - tracker.mean, 0, -1)
    nees = normalized_squared(error, np.moveaxis(tracker.covariance, (0, 1), (-2, -1)))
    found = np.count_nonzero(is_found, axis=0)
    with np.errstate(invalid="ignore"):
        return {
            "mse_m2": squared / scenario.frames,
            "wrong_share": wrong / taken,
            "swapped_share": (stands_for.any(axis=0) & ~is_found).mean(axis=0),
            "lost_share": (~stands_for.any(axis=0)).mean(axis=0),
            "final_nees": np.where(is_found, nees, 0.0).sum(axis=0) / found,
        }


def _stands_for(mean: FloatArray, truth: FloatArray) -> BoolArray:
    """Shape (N, N, B): which person each track is at, one to one, least squared distances."""
    squared = ((truth[:2, :, None] - mean[:2, None]) ** 2).sum(axis=0)
    chosen = np.empty(squared.shape, dtype=bool)
    assign_trials(_CUTOFF_M**2 - squared, chosen)
    return chosen
