"""Bearing and range as a point: the converted measurement, for those who prefer it to the EKF."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracker.containers import MeasurementModel, Measurements
from tracker.tracking.filter import initial_state, is_ranged


def convert(measurements: Measurements) -> Measurements:
    """Replace every bearing with range by its point in the fixed frame.

    A wide bearing error bends: on average the point lies short of the person, by exp(-var / 2),
    which is undone (Longbin et al., "Unbiased converted measurements for tracking", IEEE
    Transactions on Aerospace and Electronic Systems 34(3), 1998). The covariance is linear in the
    noise and breaks beyond about 3 degrees; bearings without range stay what they are.

    Args:
        measurements: M claims.

    Returns:
        As many, in the same order.
    """
    ranged = is_ranged(measurements.model, measurements.values)
    if not ranged.any():
        return measurements
    values = np.array(measurements.values)
    bearing_variance = np.minimum(measurements.covariance[:, 0, 0], 1.0)
    values[ranged, 1] *= np.exp(bearing_variance[ranged] / 2)
    mean, covariance = initial_state(
        replace(measurements, values=values),
        unknown_range_m=1.0,
        unknown_range_std_m=1.0,
        speed_std_mps=1.0,
    )
    values[ranged] = mean[ranged, :2]
    noise = np.array(measurements.covariance)
    noise[ranged] = covariance[ranged, :2, :2]
    model = np.where(ranged, MeasurementModel.CARTESIAN, measurements.model)
    return replace(measurements, values=values, covariance=noise, model=model)
