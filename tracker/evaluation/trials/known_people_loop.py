"""Many trials of people known from the start: association and update, as one loop.

The tracker's own steps for one sensor at the origin: predict, gate, assign, correct. Nobody comes
or goes, and what is assigned counts in full.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.compiling.loops import loop
from tracker.config import Config
from tracker.containers import FloatArray, IntArray, Measurements
from tracker.containers.arrays import frozen
from tracker.evaluation.trials.machine_code import machine_code
from tracker.tracking.association.association import assign
from tracker.tracking.association.gating import find_pairs
from tracker.tracking.people import TAG, room_for
from tracker.tracking.prediction.motion import Motion, carry, walk
from tracker.tracking.sensing.claims import Claims, claims_of
from tracker.tracking.settings import Settings, settings_of
from tracker.tracking.update.correction import correct


class Followed(NamedTuple):
    """What became of N people in each of B trials over T frames.

    Attributes:
        mean: Shape (B, T, N, 4), after each frame.
        covariance: Shape (B, N, 4, 4), after the last one.
        row: Shape (B, T, N): of each person's measurement, or -1.
    """

    mean: FloatArray
    covariance: FloatArray
    row: IntArray


def follow(
    mean: FloatArray,
    covariance: FloatArray,
    values: FloatArray,
    std: tuple[float, float],
    dt_s: float,
    config: Config,
) -> Followed:
    """Follow everybody. Whatever the configuration says, people walk and noise is Gaussian.

    Args:
        mean: Shape (B, N, 4), before the first frame.
        covariance: Shape (B, N, 4, 4).
        values: Shape (B, T, M, 2): bearing_rad and range_m, in no order; NaN where there is
            nothing.
        std: Of bearings and of ranges.
        dt_s: From frame to frame.
        config: Process noise, the gate, `detection_probability`, `newcomer_density`.
    """
    config = config.model_copy(update={"outlier_dof": 0.0})
    measured = values.shape[2]
    anything = Measurements.polar(np.zeros(measured), np.ones(measured), *std)
    return machine_code(follow_trials)(
        frozen(np.ascontiguousarray(mean)),
        frozen(np.ascontiguousarray(covariance)),
        frozen(np.ascontiguousarray(values)),
        claims_of(anything),
        walk(dt_s, config.acceleration_density),
        settings_of(config),
    )


def follow_trials(
    mean: FloatArray,
    covariance: FloatArray,
    values: FloatArray,
    claims: Claims,
    motion: Motion,
    settings: Settings,
) -> Followed:
    """`follow`, as a loop.

    Args:
        mean: Shape (B, N, 4).
        covariance: Shape (B, N, 4, 4).
        values: Shape (B, T, M, 2).
        claims: M claims, but for their values.
        motion: Between frames.
        settings: Of the tracker.
    """
    trials, frames, measured, _ = values.shape
    count = mean.shape[1]
    found = Followed(
        np.empty((trials, frames, count, 4)),
        np.empty((trials, count, 4, 4)),
        np.empty((trials, frames, count), np.int64),
    )
    people, root = room_for(1, count, 1), np.empty((4, 2))
    now, spread, chance = people.mean, people.covariance, np.empty(count)
    for person in range(count):
        people.weight[0, person], people.counts[TAG, person] = 1.0, -1
        chance[person] = settings.detection_probability
    rows, likeness = np.empty(measured, np.int64), np.empty((0, 0))
    for trial in range(trials):
        now[0], spread[0] = mean[trial], covariance[trial]
        for frame in range(frames):
            measurements = Claims(
                values[trial, frame], claims.noise, claims.kind, claims.pose, claims.doubt,
                claims.raised, claims.body, claims.hand, claims.tag, claims.bias,
            )  # fmt: skip
            for person in range(count):
                carry(now, spread, 0, person, motion, now, spread)
            end = _measured(values[trial, frame], rows)
            pairs = find_pairs(
                people, now, spread, measurements, rows[:end], chance, likeness,
                settings.newcomer_density, settings,
            )  # fmt: skip
            chosen = assign(pairs, count, measured)
            for person in range(count):
                row = -1 if chosen[person] < 0 else pairs.claim[chosen[person]]
                found.row[trial, frame, person] = row
                if row >= 0:
                    correct(
                        now, spread, 0, person, measurements, row, 0.0,
                        now, spread, person, root,
                    )  # fmt: skip
                for i in range(4):
                    found.mean[trial, frame, person, i] = now[0, person, i]
        found.covariance[trial] = spread[0]
    return found


@loop
def _measured(values: FloatArray, rows: IntArray) -> int:
    """Write down which measurements there are; gives how many."""
    count = 0
    for row in range(len(values)):
        if not np.isnan(values[row, 0]):
            rows[count] = row
            count += 1
    return count
