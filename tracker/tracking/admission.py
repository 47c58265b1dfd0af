"""Which measurements may come in? Sane numbers, once per person, with honest noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, Measurements, SensorKind
from tracker.containers.measurement_check import (
    ABSURD_M,
    BEARING_VARIANCE_MAX,
    VARIANCE_MAX,
    VARIANCE_MIN,
)
from tracker.tracking.filter import positions

#: A hand that is up may be so far from where its owner is expected (guess).
CALLER_REACH_M = 0.7
#: Frames closer together than this are as one where errors are alike.
_INTERVAL_MIN_S = 0.01


def usable(measurements: Measurements) -> BoolArray:
    """Shape (M,): rows that a filter can live with, finite and with a positive definite R."""
    if _is_plain(measurements):
        return np.ones(len(measurements), dtype=bool)
    values, covariance = measurements.values, measurements.covariance
    first, second, mixed = covariance[:, 0, 0], covariance[:, 1, 1], covariance[:, 0, 1]
    polar = measurements.kind != SensorKind.POSITION
    far = np.abs(values) < ABSURD_M  # NaN compares as false, which is what is meant throughout
    pose = np.abs(measurements.sensor_pose).max(axis=1, initial=0.0) < ABSURD_M
    sane = far[:, 0] & (far[:, 1] | (polar & np.isnan(values[:, 1]))) & pose
    sane &= ~(polar & (values[:, 1] < 0.0))
    sane &= (np.minimum(first, second) > VARIANCE_MIN) & (second < VARIANCE_MAX)
    sane &= first < np.where(polar, BEARING_VARIANCE_MAX, VARIANCE_MAX)
    if mixed.any() or covariance[:, 1, 0].any():
        # The correlation must be below one, with room for rounding.
        spread = np.sqrt(np.where(sane, first, 1.0) * np.where(sane, second, 1.0))
        sane &= np.abs(mixed) < (1.0 - 1e-9) * spread
        mirrored = np.where(sane, covariance[:, 1, 0], 0.0)
        sane &= np.abs(np.where(sane, mixed, 0.0) - mirrored) <= 1e-9 * spread
    if measurements.sensor_pose_covariance.any():
        sane &= is_semidefinite(measurements.sensor_pose_covariance)
    return np.asarray(sane)


def _is_plain(measurements: Measurements) -> bool:
    """Every row has a range or position and is beyond doubt: said of all at once, it is cheap."""
    if len(measurements) == 0 or measurements.sensor_pose_covariance.any():
        return False
    noise = measurements.covariance.reshape(-1, 4)
    low, mixed, mixed_too, low_second = noise.min(axis=0).tolist()
    high, mixed_high, mixed_too_high, high_second = noise.max(axis=0).tolist()
    return bool(
        mixed == mixed_too == mixed_high == mixed_too_high == 0.0
        and min(low, low_second) > VARIANCE_MIN
        and high < BEARING_VARIANCE_MAX
        and high_second < VARIANCE_MAX
        and np.abs(measurements.values).max() < ABSURD_M
        and np.abs(measurements.sensor_pose).max() < ABSURD_M
        and (measurements.values[:, 1].min() >= 0.0 or measurements.kind.all())
    )


def once_per_person(raised: Measurements, callers_m: FloatArray, config: Config) -> Measurements:
    """Two raised hands of one person count once: the first row of each person stays.

    Hands close together are one person's, but as many of them count as customers call there.

    Args:
        raised: Raised hands.
        callers_m: Shape (C, 2): where customers are expected whose hands were up.
        config: `unknown_range_m`, `same_person_distance_m`.
    """
    if len(raised) < 2:
        return raised
    if raised.person.max() >= 0:
        _, first = np.unique(raised.person, return_index=True)
        keep = raised.person < 0
        keep[first] = True
        raised = raised[keep]
    xy = positions(raised, config.unknown_range_m)
    close: BoolArray = is_close(xy, xy, config.same_person_distance_m)
    if np.count_nonzero(close) <= len(raised):  # everybody is close to themselves alone
        return raised
    keep = np.ones(len(raised), dtype=bool)
    callers = is_close(xy, callers_m, CALLER_REACH_M).sum(axis=1)
    for row in np.flatnonzero(np.tril(close, -1).any(axis=1)):
        keep[row] = np.count_nonzero(close[row, :row] & keep[:row]) < max(1, callers[row])
    return raised[keep]


def is_close(xy_m: FloatArray, others_m: FloatArray, distance_m: float) -> BoolArray:
    """Shape (A, B): which points are closer together than a distance."""
    square = xy_m[:, None, 0] - others_m[:, 0]
    square *= square
    across = xy_m[:, None, 1] - others_m[:, 1]
    across *= across
    square += across
    return np.asarray(square < distance_m**2)


def with_hand_bias(raised: Measurements, dt_s: float, config: Config) -> Measurements:
    """Widen bearings whose errors are alike from frame to frame.

    A raised hand stands beside the body, to the same side for as long as it is up. Errors with the
    correlation rho from frame to frame tell, over many frames, as much as independent ones with
    (1 + rho) / (1 - rho) times the variance. Where the scan has shown the body itself, its range
    is known and there is no such bias. The first look at somebody is taken for worse than it is.

    Args:
        raised: Raised hands.
        dt_s: Since the last frame.
        config: `hand_bias_duration_s`; 0 changes nothing.
    """
    alone = np.isnan(raised.values[:, 1])
    if config.hand_bias_duration_s == 0.0 or not alone.any():
        return raised
    noise = np.array(raised.covariance)
    noise[alone, 0, 0] = np.minimum(
        noise[alone, 0, 0] * hand_bias(dt_s, config), BEARING_VARIANCE_MAX
    )
    return replace(raised, covariance=noise)


def hand_bias(dt_s: float, config: Config) -> float:
    """How many times the variance of independent errors such bearings have; 1 where it is off."""
    if config.hand_bias_duration_s == 0.0:
        return 1.0
    alike = np.exp(-max(dt_s, _INTERVAL_MIN_S) / config.hand_bias_duration_s)
    return float((1.0 + alike) / (1.0 - alike))


def is_semidefinite(covariance: FloatArray) -> BoolArray:
    """Shape (M,): which of the matrices, shape (M, 3, 3), could be a covariance."""
    finite = np.asarray((np.abs(covariance) < VARIANCE_MAX).all(axis=(1, 2)))
    safe = np.where(finite[:, None, None], covariance, 0.0)
    symmetric = np.abs(safe - np.swapaxes(safe, 1, 2)).max(axis=(1, 2))
    least, most = np.linalg.eigvalsh(safe)[:, [0, -1]].T
    return np.asarray(finite & (symmetric <= 1e-9 * most) & (least >= -1e-9 * most))
