"""What was measured, as loops take it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, IntArray, Measurements, SensorKind
from tracker.containers.arrays import sealed

#: Frames closer together than this are as one where errors are alike.
_INTERVAL_MIN_S = 0.01
#: A bearing with a wider variance than a full turn's says nothing.
_BEARING_VARIANCE_MAX = (2.0 * np.pi) ** 2


class Claims(NamedTuple):
    """The arrays of `Measurements`, M rows.

    Attributes:
        values: Shape (M, 2).
        noise: Shape (M, 2, 2): R.
        kind: Shape (M,), of `SensorKind`.
        pose: Shape (M, 3): of the sensor.
        doubt: Shape (M, 3, 3): covariance of the pose.
        raised: Shape (M,).
        body: Shape (M,): claims that share a number from 0 on come from one body.
        hand: Shape (M,).
        tag: Shape (M,): hints of identity.
    """

    values: FloatArray
    noise: FloatArray
    kind: IntArray
    pose: FloatArray
    doubt: FloatArray
    raised: BoolArray
    body: IntArray
    hand: IntArray
    tag: IntArray


def claims_of(measurements: Measurements, dt_s: float | FloatArray, config: Config) -> Claims:
    """Measurements for the loops, bearings of raised hands with honest noise.

    A raised hand stands beside the body, to the same side for as long as it is up. Errors with the
    correlation rho from frame to frame tell, over many frames, as much as independent ones with
    (1 + rho) / (1 - rho) times the variance. Where a range is known there is no such bias: the
    body itself was seen.

    Args:
        measurements: M of them.
        dt_s: Since the last frame; shape (M,) for measurements of several frames.
        config: `hand_bias_duration_s`; 0 changes nothing.
    """
    noise = measurements.covariance
    if config.hand_bias_duration_s > 0.0:
        alone = measurements.raised & (measurements.kind == SensorKind.BEARING)
        alike = np.exp(-np.maximum(dt_s, _INTERVAL_MIN_S) / config.hand_bias_duration_s)
        alike = np.broadcast_to(alike, alone.shape)[alone]
        noise = noise.copy()
        wider = noise[alone, 0, 0] * (1.0 + alike) / (1.0 - alike)
        noise[alone, 0, 0] = np.minimum(wider, _BEARING_VARIANCE_MAX)
        sealed(noise)
    arrays: tuple[Any, ...] = (
        *(measurements.values, noise, measurements.kind, measurements.sensor_pose),
        *(measurements.sensor_pose_covariance, measurements.raised, measurements.person),
        *(measurements.hand, measurements.identity),
    )
    return Claims(*[each if each.flags.c_contiguous else sealed(each.copy()) for each in arrays])
