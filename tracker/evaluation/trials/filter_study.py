"""One person per trial, many trials at once: is the filter optimal and consistent?

Trials go through the tracker's own prediction and correction. Everybody moves at nearly constant
velocity, and the filter knows (whatever `motion` says).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracker.config import Config
from tracker.containers import FloatArray, Measurements
from tracker.containers.arrays import frozen, sealed
from tracker.evaluation.metrics.consistency import normalized_squared
from tracker.evaluation.metrics.constant_velocity import process_noise
from tracker.evaluation.metrics.cramer_rao import polar_information
from tracker.evaluation.trials.filter_loop import filter_trials
from tracker.evaluation.trials.machine_code import machine_code
from tracker.evaluation.trials.scenario import FilterScenario
from tracker.evaluation.trials.trial_seed import trial_rng
from tracker.geometry import normalize_angle
from tracker.tracking.prediction.motion import walk
from tracker.tracking.sensing.claims import claims_of


@dataclass(frozen=True, slots=True, eq=False)
class FilterTrials:
    """What was drawn: B people over T frames.

    Attributes:
        prior_mean: Shape (B, 4): what the filter is told at the beginning.
        truth: Shape (T, B, 4).
        bearing_rad: Shape (T, B), measured from the origin.
        range_m: Shape (T, B), measured.
    """

    prior_mean: FloatArray
    truth: FloatArray
    bearing_rad: FloatArray
    range_m: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class FilterErrors:
    """How the filter did, frame by frame and trial by trial.

    Attributes:
        squared_error_m2: Shape (T, B), of the position.
        nees: Shape (T, B), of position and velocity; 4 on average if the filter is right.
        information: Shape (T, B, 2, 2), that each measurement held about the position.
    """

    squared_error_m2: FloatArray
    nees: FloatArray
    information: FloatArray


def prior_covariance(scenario: FilterScenario) -> FloatArray:
    """Shape (4, 4): how well the filter knows the beginning."""
    variances = [scenario.start_std_m**2] * 2 + [scenario.speed_std_mps**2] * 2
    return np.diag(variances)


def draw_filter_trials(
    scenario: FilterScenario, seed: int, first: int, count: int
) -> FilterTrials:
    """Draw what happens and what is measured; each trial from its own generator.

    Args:
        scenario: Motion and noise.
        seed: Of the study.
        first: Number of the first trial.
        count: How many.
    """
    frames, dt_s = scenario.frames, 1.0 / scenario.rate_hz
    normal = np.empty((count, 4 * (frames + 1) + 3 * frames))
    even = np.empty((count, frames))
    for row in range(count):
        rng = trial_rng(seed, first + row)
        normal[row] = rng.standard_normal(normal.shape[1])
        even[row] = rng.random(frames)
    walk = normal[:, : 4 * (frames + 1)].reshape(count, frames + 1, 4)
    noise = normal[:, 4 * (frames + 1) :].reshape(count, frames, 3)

    prior_mean = np.zeros((count, 4))
    prior_mean[:, 0] = scenario.start_m
    state = prior_mean + _spread(walk[:, 0], np.linalg.cholesky(prior_covariance(scenario)))
    root = np.linalg.cholesky(process_noise(dt_s, scenario.acceleration_density))
    truth = np.empty((frames, count, 4))
    for frame in range(frames):
        moved = state[:, :2] + dt_s * state[:, 2:]
        state = np.concatenate([moved, state[:, 2:]], axis=1) + _spread(walk[:, frame + 1], root)
        truth[frame] = state

    x, y = truth[..., 0], truth[..., 1]
    bearing = np.arctan2(y, x) + np.deg2rad(scenario.bearing_std_deg) * noise[..., 0].T
    range_m = np.hypot(x, y) + scenario.range_std_m * noise[..., 1].T
    outlier = even.T < scenario.outlier_share
    range_m += np.where(outlier, scenario.outlier_std_m * noise[..., 2].T, 0.0)
    return FilterTrials(prior_mean, truth, normalize_angle(bearing), np.maximum(range_m, 0.0))


def _spread(normal: FloatArray, root: NDArray[np.floating]) -> FloatArray:
    """Root times each row; the last bit of a matrix product would depend on how many rows."""
    return np.asarray((normal[:, None, :] * root).sum(axis=-1))


def run_filter(
    scenario: FilterScenario, config: Config, trials: FilterTrials
) -> tuple[FloatArray, FloatArray]:
    """Filter all trials at once.

    Args:
        scenario: Rate and noise, as the filter is told them.
        config: The tracker's parameters.
        trials: What is measured.

    Returns:
        Means, shape (T, B, 4), and covariances, shape (T, B, 4, 4), after each measurement.
    """
    count = trials.bearing_rad.shape[1]
    anything = Measurements.polar(
        np.zeros(count),
        np.ones(count),
        np.deg2rad(scenario.bearing_std_deg),
        scenario.range_std_m,
    )
    return machine_code(filter_trials)(
        frozen(trials.prior_mean),
        sealed(np.tile(prior_covariance(scenario), (count, 1, 1))),
        sealed(np.stack([trials.bearing_rad, trials.range_m], axis=-1)),
        claims_of(anything),
        walk(1.0 / scenario.rate_hz, config.acceleration_density),
        config.outlier_dof,
    )


def filter_errors(
    scenario: FilterScenario, config: Config, seed: int, first: int, count: int
) -> FilterErrors:
    """Draw trials, filter them, compare with the truth.

    Args:
        scenario: What happens.
        config: The tracker's parameters.
        seed: Of the study.
        first: Number of the first trial.
        count: How many, all at once.
    """
    trials = draw_filter_trials(scenario, seed, first, count)
    means, covariances = run_filter(scenario, config, trials)
    error = trials.truth - means
    return FilterErrors(
        squared_error_m2=(error[..., :2] ** 2).sum(axis=-1),
        nees=normalized_squared(error, covariances),
        information=polar_information(
            trials.truth[..., :2],
            np.zeros(2),
            float(np.deg2rad(scenario.bearing_std_deg)),
            scenario.range_std_m,
        ),
    )
