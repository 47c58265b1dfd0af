"""Measurements as plain arrays for the compiled loops."""

from __future__ import annotations

from typing import Any, NamedTuple

from tracker.containers import BoolArray, FloatArray, IntArray, Measurements
from tracker.containers.arrays import sealed


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
        bias: Shape (M, 2, 2): covariance of what lasts of the place's error.
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
    bias: FloatArray


def claims_of(measurements: Measurements) -> Claims:
    """Measurements for the loops."""
    arrays: tuple[Any, ...] = (
        *(measurements.values, measurements.covariance, measurements.kind),
        *(measurements.sensor_pose, measurements.sensor_pose_covariance, measurements.raised),
        *(measurements.person, measurements.hand, measurements.identity),
        measurements.bias_covariance,
    )
    return Claims(*[each if each.flags.c_contiguous else sealed(each.copy()) for each in arrays])
