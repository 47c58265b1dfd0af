"""What does a measurement say about a track? The extended Kalman filter on polar measurements.

A bearing and a range are compared where they were taken, in the sensor's frame, so that a wide
bearing error at a long range does not have to pass for a Gaussian in x and y. Cartesian
measurements go through the same code with a linear model.
"""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray, MeasurementModel, Measurements
from tracker.geometry import normalize_angle

#: Nearer than this to the sensor a bearing turns too fast to be linear.
_RANGE_FLOOR_M = 0.1


def innovations(
    mean: FloatArray, covariance: FloatArray, measurements: Measurements
) -> tuple[FloatArray, FloatArray]:
    """Measured minus predicted, and its covariance S = H P H' + R, of every pair.

    Args:
        mean: Shape (N, 4), in the fixed frame.
        covariance: Shape (N, 4, 4).
        measurements: M claims.

    Returns:
        Innovations, shape (N, M, 2), bearings wrapped to [-pi, pi), and S, shape (N, M, 2, 2). A
        missing range has innovation 0 and variance 1 of its own, and so weighs nothing.
    """
    predicted, jacobian = _predict_measurements(mean, measurements)
    innovation = measurements.values - predicted
    polar = measurements.model == MeasurementModel.POLAR
    innovation[:, polar, 0] = normalize_angle(innovation[:, polar, 0])
    jacobian, innovation = _without_missing(jacobian, innovation, measurements)
    position = covariance[:, None, :2, :2]
    spread = jacobian @ position @ np.swapaxes(jacobian, -1, -2) + measurements.covariance
    return innovation, spread


def update(
    mean: FloatArray, covariance: FloatArray, measurements: Measurements
) -> tuple[FloatArray, FloatArray]:
    """Posterior of K tracks, each with the one measurement of its row (Joseph's form).

    Args:
        mean: Shape (K, 4).
        covariance: Shape (K, 4, 4).
        measurements: K claims; row i belongs to track i.

    Returns:
        Mean and covariance of the same shapes; the covariance stays symmetric positive definite.
    """
    rows = np.arange(len(mean))
    predicted, jacobian = _predict_measurements(mean, measurements)
    predicted, jacobian = predicted[rows, rows], jacobian[rows, rows]
    innovation = measurements.values - predicted
    polar = measurements.model == MeasurementModel.POLAR
    innovation[polar, 0] = normalize_angle(innovation[polar, 0])
    jacobian, innovation = _without_missing(jacobian, innovation, measurements)

    observation = np.zeros((len(mean), 2, 4))
    observation[:, :, :2] = jacobian
    transposed = np.swapaxes(observation, -1, -2)
    cross = covariance @ transposed
    spread = observation @ cross + measurements.covariance
    gain = np.swapaxes(np.linalg.solve(spread, np.swapaxes(cross, -1, -2)), -1, -2)
    rest = np.eye(4) - gain @ observation
    posterior = rest @ covariance @ np.swapaxes(rest, -1, -2)
    posterior += gain @ measurements.covariance @ np.swapaxes(gain, -1, -2)
    posterior = (posterior + np.swapaxes(posterior, -1, -2)) / 2
    return mean + (gain @ innovation[..., None])[..., 0], posterior


def initial_state(
    measurements: Measurements,
    *,
    unknown_range_m: float,
    unknown_range_std_m: float,
    speed_std_mps: float,
) -> tuple[FloatArray, FloatArray]:
    """First estimate of somebody from one measurement: there, and standing as far as we know.

    Args:
        measurements: K claims.
        unknown_range_m: Supposed range of a claim that is a bearing only ...
        unknown_range_std_m: ... and its standard deviation.
        speed_std_mps: Spread of the speed, per axis.

    Returns:
        Mean, shape (K, 4), and covariance, shape (K, 4, 4).
    """
    count = len(measurements)
    mean = np.zeros((count, 4))
    covariance = np.zeros((count, 4, 4))
    covariance[:, [2, 3], [2, 3]] = speed_std_mps**2
    polar = measurements.model == MeasurementModel.POLAR
    mean[:, :2] = measurements.values
    covariance[:, :2, :2] = measurements.covariance

    claims, pose = measurements[polar], measurements.sensor_pose[polar]
    bearing_only = np.isnan(claims.values[:, 1])
    range_m = np.where(bearing_only, unknown_range_m, claims.values[:, 1])
    spread = np.array(claims.covariance)
    spread[bearing_only, 1, :] = spread[bearing_only, :, 1] = 0.0
    spread[bearing_only, 1, 1] = unknown_range_std_m**2
    angle = claims.values[:, 0] + pose[:, 2]
    cos, sin = np.cos(angle), np.sin(angle)
    mean[polar, :2] = pose[:, :2] + range_m[:, None] * np.stack([cos, sin], axis=-1)
    turn = np.empty((len(claims), 2, 2))
    turn[:, 0, 0], turn[:, 0, 1] = -range_m * sin, cos
    turn[:, 1, 0], turn[:, 1, 1] = range_m * cos, sin
    covariance[polar, :2, :2] = turn @ spread @ np.swapaxes(turn, -1, -2)
    return mean, covariance


def _predict_measurements(
    mean: FloatArray, measurements: Measurements
) -> tuple[FloatArray, FloatArray]:
    """What each sensor would measure of each track, (N, M, 2), and its Jacobian in x and y."""
    offset = mean[:, None, :2] - measurements.sensor_pose[None, :, :2]
    dx, dy = offset[..., 0], offset[..., 1]
    range_m = np.maximum(np.hypot(dx, dy), _RANGE_FLOOR_M)
    polar = measurements.model == MeasurementModel.POLAR
    predicted = np.empty(offset.shape)
    bearing = np.arctan2(dy, dx) - measurements.sensor_pose[None, :, 2]
    predicted[..., 0] = np.where(polar, bearing, mean[:, None, 0])
    predicted[..., 1] = np.where(polar, range_m, mean[:, None, 1])
    jacobian = np.empty((*offset.shape, 2))
    jacobian[..., 0, 0] = np.where(polar, -dy / range_m**2, 1.0)
    jacobian[..., 0, 1] = np.where(polar, dx / range_m**2, 0.0)
    jacobian[..., 1, 0] = np.where(polar, dx / range_m, 0.0)
    jacobian[..., 1, 1] = np.where(polar, dy / range_m, 1.0)
    return predicted, jacobian


def _without_missing(
    jacobian: FloatArray, innovation: FloatArray, measurements: Measurements
) -> tuple[FloatArray, FloatArray]:
    missing = np.isnan(measurements.values[:, 1])
    jacobian[..., missing, 1, :] = 0.0
    innovation[..., missing, 1] = 0.0
    return jacobian, innovation
