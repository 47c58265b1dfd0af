"""Many trials of people known from the start: association and update, as one loop.

The tracker's own steps for one sensor at the origin: predict, gate, assign, correct. Nobody comes
or goes, and what is assigned counts in full.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.compiling.loops import maker, step
from tracker.config import Config
from tracker.containers import FloatArray, IntArray, Measurements
from tracker.containers.arrays import frozen
from tracker.evaluation.trials.machine_code import machine_code
from tracker.tracking.association.association import assign
from tracker.tracking.association.gating import Pairs, floored
from tracker.tracking.prediction.motion import Motion, carry, walk
from tracker.tracking.sensing.claims import Claims, claims_of
from tracker.tracking.sensing.innovation import (
    innovation_of,
    noise_of,
    seen_from,
    squared_distance,
)
from tracker.tracking.sensing.sensor_kinds import BEARING_RANGE, area
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
    chance, nobody = config.detection_probability, 2.0 * np.pi * config.newcomer_density
    measured = values.shape[2]
    anything = Measurements.polar(np.zeros(measured), np.ones(measured), *std)
    return machine_code(follow_trials)(
        frozen(np.ascontiguousarray(mean)),
        frozen(np.ascontiguousarray(covariance)),
        frozen(np.ascontiguousarray(values)),
        claims_of(anything),
        walk(dt_s, config.acceleration_density),
        float(np.log(chance / (1.0 - chance) / nobody)),
        settings_of(config),
    )


def follow_trials(
    mean: FloatArray,
    covariance: FloatArray,
    values: FloatArray,
    claims: Claims,
    motion: Motion,
    log_chance: float,
    settings: Settings,
) -> Followed:
    """`follow`, as a loop.

    Args:
        mean: Shape (B, N, 4).
        covariance: Shape (B, N, 4, 4).
        values: Shape (B, T, M, 2).
        claims: M claims, but for their values.
        motion: Between frames.
        log_chance: What all pairs have in common of their log-odds.
        settings: Of the tracker.
    """
    trials, frames, measured, _ = values.shape
    count = mean.shape[1]
    found = Followed(
        np.empty((trials, frames, count, 4)),
        np.empty((trials, count, 4, 4)),
        np.empty((trials, frames, count), np.int64),
    )
    now, spread, root = np.empty((1, count, 4)), np.empty((1, count, 4, 4)), np.empty((4, 2))
    room = _room_for_pairs(count * measured)
    for trial in range(trials):
        now[0], spread[0] = mean[trial], covariance[trial]
        for frame in range(frames):
            measurements = Claims(
                values[trial, frame], claims.noise, claims.kind, claims.pose, claims.doubt,
                claims.raised, claims.body, claims.hand, claims.tag, claims.bias,
            )  # fmt: skip
            for person in range(count):
                carry(now, spread, 0, person, motion, now, spread)
            end = _find_pairs(now, spread, measurements, log_chance, settings, room)
            pairs = Pairs(
                room.track[:end], room.claim, room.log_likelihood, room.log_newcomer, room.log_odds
            )
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


@maker
def _room_for_pairs(count: int) -> Pairs:
    whole, number = np.empty(count, np.int64), np.empty(count)
    return Pairs(whole, whole.copy(), np.empty((count, 1)), number, number.copy())


@step
def _find_pairs(
    mean: FloatArray,
    covariance: FloatArray,
    claims: Claims,
    log_chance: float,
    settings: Settings,
    room: Pairs,
) -> int:
    """`gating.find_pairs`, written to `room`, where all claims have one sensor and one noise.

    So what the sensor would see of somebody is worked out once for all of them.
    """
    pairs, limit = 0, settings.ranged_limit
    r = noise_of(BEARING_RANGE, claims, 0)
    for person in range(mean.shape[1]):
        expected, h, own, doubt = seen_from(BEARING_RANGE, mean, covariance, 0, person, claims, 0)
        own = floored(own, h, doubt, settings)
        s = own[0] + r[0], own[1] + r[1], own[2] + r[2]
        for row in range(len(claims.values)):
            y = innovation_of(BEARING_RANGE, expected, claims, row)
            if not y[0] * y[0] <= limit * s[0]:  # most pairs, and those with nothing
                continue
            distance, spanned = squared_distance(y, s, 0.0)
            if distance <= limit:
                own_area = area(BEARING_RANGE, claims, row, settings)
                log_newcomer = 0.5 * np.log(spanned * own_area * own_area)
                room.track[pairs], room.claim[pairs] = person, row
                room.log_odds[pairs] = log_chance - 0.5 * distance - log_newcomer
                pairs += 1
    return pairs
