"""How good could any filter be? The posterior Cramer-Rao bound for people seen from a sensor."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray
from tracker.evaluation.metrics.constant_velocity import process_noise, transition


def polar_information(
    xy_m: FloatArray, sensor_xy_m: FloatArray, bearing_std_rad: float, range_std_m: float
) -> FloatArray:
    """Information about x and y in one measurement of bearing and range: H' inv(R) H.

    Args:
        xy_m: Shape (..., 2), where the person is.
        sensor_xy_m: Shape (..., 2), where the sensor is.
        bearing_std_rad: Noise of the bearing.
        range_std_m: Noise of the range; infinite for a bearing alone.

    Returns:
        Shape (..., 2, 2), Fisher information in 1 / m^2.
    """
    offset = xy_m - sensor_xy_m
    squared = (offset**2).sum(axis=-1)[..., None, None]
    along = offset[..., :, None] * offset[..., None, :] / squared
    across = np.eye(2) - along
    return np.asarray(along / range_std_m**2 + across / (squared * bearing_std_rad**2))


def posterior_bound(
    prior_covariance: FloatArray, information: FloatArray, dt_s: float, acceleration_density: float
) -> FloatArray:
    """Least error covariance after each measurement, for linear motion.

    J(k+1) = inv(Q + F inv(J(k)) F') + E[H' inv(R) H]. With the expected information, the mean over
    possible paths, this bounds every estimator, loosely where people may come close to the
    sensor. With the information along one path it is what a filter can reach on that path (so
    computes Stone Soup's PCRBMetric); its mean over the paths is the closer yardstick.

    Args:
        prior_covariance: Shape (4, 4), of x, y, vx, vy before the first interval.
        information: Shape (T, ..., 2, 2), of each measurement about x and y.
        dt_s: Interval before each measurement.
        acceleration_density: Process noise, m^2/s^3.

    Returns:
        Shape (T, ..., 4, 4).

    Source: Tichavsky, Muravchik, Nehorai, "Posterior Cramer-Rao bounds for discrete-time nonlinear
        filtering", IEEE Transactions on Signal Processing 46(5), 1998.
    """
    step, noise = transition(dt_s), process_noise(dt_s, acceleration_density)
    bound = np.empty((*information.shape[:-2], 4, 4))
    covariance = prior_covariance
    for frame, gained in enumerate(information):
        prior = step @ covariance @ step.T + noise
        # inv(inv(P) + H' J H) without inverting P: what is gained concerns the position alone.
        weight = np.linalg.solve(np.eye(2) + gained @ prior[..., :2, :2], gained)
        lost = prior[..., :, :2] @ weight @ prior[..., :2, :]
        covariance = bound[frame] = prior - (lost + np.swapaxes(lost, -1, -2)) / 2.0
    return bound
