"""What does a measurement say about a track? The extended Kalman filter on polar measurements.

A bearing and a range are compared where they were taken, in the sensor's frame, so that a wide
bearing error at a long range does not have to pass for a Gaussian in x and y. Cartesian
measurements go through the same code with a linear model. Leading axes (trials, modes of motion)
pass through everything here.
"""

from __future__ import annotations

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray, Measurements, SensorKind
from tracker.geometry import normalize_angle
from tracker.tracking.outliers import outlier_noise
from tracker.tracking.sensor_model import RANGE_FLOOR_M, expect_cartesian, expect_polar, pose_noise

#: A measurement's variance counts for at least this share of what the track itself contributes to
#: the innovation: beyond it the posterior would drown in rounding errors.
NOISE_SHARE_MIN = 1e-9


def innovations(
    mean: FloatArray, covariance: FloatArray, measurements: Measurements
) -> tuple[FloatArray, FloatArray]:
    """Measured minus predicted, and its covariance S = H P H' + R, of every pair.

    Args:
        mean: Shape (..., N, 4), in the fixed frame.
        covariance: Shape (..., N, 4, 4).
        measurements: M claims.

    Returns:
        Innovations, shape (..., N, M, 2), bearings wrapped to [-pi, pi), and S, shape
        (..., N, M, 2, 2). A missing range has innovation 0, and so weighs nothing.
    """
    pairs = (*mean.shape[:-1], len(measurements))
    broad = np.broadcast_to(mean[..., None, :], (*pairs, 4))
    innovation, jacobian, noise = compare(broad, measurements)
    position = covariance[..., None, :2, :2]
    return innovation, jacobian @ position @ np.swapaxes(jacobian, -1, -2) + noise


def update(
    mean: FloatArray, covariance: FloatArray, measurements: Measurements, outlier_dof: float = 0.0
) -> tuple[FloatArray, FloatArray]:
    """Posterior of K tracks, each with the one measurement of its row.

    Args:
        mean: Shape (..., K, 4).
        covariance: Shape (..., K, 4, 4).
        measurements: K claims; row i belongs to track i.
        outlier_dof: Degrees of freedom of the ranges' Student-t noise; 0 is Gaussian.

    Returns:
        Mean and covariance of the same shapes; the covariance stays symmetric positive definite.
    """
    innovation, jacobian, noise = compare(mean, measurements)
    if outlier_dof > 0.0:
        ranged = is_ranged(measurements.kind)[:, None, None]
        spread = jacobian @ covariance[..., :2, :2] @ np.swapaxes(jacobian, -1, -2)
        doubtful = outlier_noise(spread, innovation, noise, outlier_dof)
        noise = np.where(ranged, doubtful, noise)
    return correct(mean, covariance, innovation, jacobian, noise)


def compare(
    mean: FloatArray, measurements: Measurements
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Hold each measurement against the track of its row.

    Args:
        mean: Shape (..., K, 4).
        measurements: K claims.

    Returns:
        Measured minus predicted, shape (..., K, 2); its derivative by x and y, shape
        (..., K, 2, 2); and the measurements' noise, of the same shape, with what the uncertainty
        of the sensor's pose adds to it.
    """
    polar = measurements.kind != SensorKind.POSITION
    values, noise = measurements.values, measurements.covariance
    if polar.all():
        predicted, jacobian = expect_polar(mean, measurements.sensor_pose)
    else:
        predicted, jacobian = (np.array(part) for part in expect_cartesian(mean))
        predicted[..., polar, :], jacobian[..., polar, :, :] = expect_polar(
            mean[..., polar, :], measurements.sensor_pose[polar]
        )
    innovation = values - predicted
    if polar.any():
        innovation[..., polar, 0] = normalize_angle(innovation[..., polar, 0])
    noise = np.broadcast_to(noise, jacobian.shape)
    if measurements.sensor_pose_covariance.any():
        doubt = pose_noise(jacobian, measurements.sensor_pose_covariance)
        noise = noise + np.where(polar[:, None, None], doubt, 0.0)
    missing = np.isnan(values[:, 1])
    if missing.any():
        innovation[..., missing, 1] = 0.0
        jacobian[..., missing, 1, :] = 0.0
        noise = np.where(missing[:, None, None], noise * np.diag([1.0, 0.0]), noise)
        noise[..., missing, 1, 1] = 1.0
    return innovation, jacobian, noise


def correct(
    mean: FloatArray,
    covariance: FloatArray,
    innovation: FloatArray,
    jacobian: FloatArray,
    noise: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """The Kalman filter's measurement update, x + K y and P - K S K', two numbers at a time.

    With S = L L' the gain's part is a square, W W' where W = P H' inv(L)': what is taken off P is
    symmetric as it stands.

    Args:
        mean: Shape (..., 4).
        covariance: Shape (..., 4, 4).
        innovation: Shape (..., 2): y.
        jacobian: Shape (..., 2, 2): H, by x and y alone.
        noise: Shape (..., 2, 2): R.
    """
    cross = covariance[..., :2] @ np.swapaxes(jacobian, -1, -2)
    own = jacobian @ cross[..., :2, :]
    s00 = own[..., 0, 0] + np.maximum(noise[..., 0, 0], NOISE_SHARE_MIN * own[..., 0, 0])
    s11 = own[..., 1, 1] + np.maximum(noise[..., 1, 1], NOISE_SHARE_MIN * own[..., 1, 1])
    s01 = own[..., 0, 1] + noise[..., 0, 1]
    # inv(L) of the 2x2 Cholesky factor, row by row.
    l00 = np.sqrt(s00)
    l10 = s01 / l00
    l11 = np.sqrt(s11 - l10 * l10)
    first = cross[..., 0] / l00[..., None]
    second = (cross[..., 1] - l10[..., None] * first) / l11[..., None]
    y0 = innovation[..., 0] / l00
    y1 = (innovation[..., 1] - l10 * y0) / l11
    root = np.stack([first, second], axis=-1)
    posterior = covariance - root @ np.swapaxes(root, -1, -2)
    posterior = (posterior + np.swapaxes(posterior, -1, -2)) * 0.5
    return mean + first * y0[..., None] + second * y1[..., None], posterior


def is_ranged(kind: IntArray) -> BoolArray:
    """Shape (M,): claims that are a bearing and a range."""
    return np.asarray(kind == SensorKind.BEARING_RANGE)


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
    polar = measurements.kind != SensorKind.POSITION
    bearing_only = polar & np.isnan(measurements.values[:, 1])
    mean[:, :2] = positions(measurements, unknown_range_m)

    noise = np.array(measurements.covariance)
    if bearing_only.any():
        noise[bearing_only, 1, :] = noise[bearing_only, :, 1] = 0.0
        noise[bearing_only, 1, 1] = unknown_range_std_m**2
    if measurements.sensor_pose_covariance.any():
        _, jacobian = expect_polar(mean, measurements.sensor_pose)
        doubt = pose_noise(jacobian, measurements.sensor_pose_covariance)
        noise += np.where(polar[:, None, None], doubt, 0.0)
    turn = np.tile(np.eye(2), (count, 1, 1))  # derivative of the place by the measurement
    if polar.any():
        range_m = np.where(bearing_only, unknown_range_m, measurements.values[:, 1])[polar]
        range_m = np.maximum(range_m, RANGE_FLOOR_M)
        angle = (measurements.values[:, 0] + measurements.sensor_pose[:, 2])[polar]
        cos, sin = np.cos(angle), np.sin(angle)
        turn[polar, 0, 0], turn[polar, 0, 1] = -range_m * sin, cos
        turn[polar, 1, 0], turn[polar, 1, 1] = range_m * cos, sin
    covariance[:, :2, :2] = turn @ noise @ np.swapaxes(turn, -1, -2)
    return mean, covariance


def positions(measurements: Measurements, unknown_range_m: float) -> FloatArray:
    """Where claims are in the fixed frame, shape (M, 2); bearings at a supposed range."""
    values, pose = measurements.values, measurements.sensor_pose
    polar = measurements.kind != SensorKind.POSITION
    if not polar.any():
        return values
    range_m = np.where(np.isnan(values[:, 1]), unknown_range_m, values[:, 1])
    angle = values[:, 0] + pose[:, 2]
    xy = np.empty(values.shape)
    xy[:, 0] = pose[:, 0] + range_m * np.cos(angle)
    xy[:, 1] = pose[:, 1] + range_m * np.sin(angle)
    return xy if polar.all() else np.where(polar[:, None], xy, values)
