"""How do people move between two stamps? Nearly constant velocity, white-noise acceleration."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray


def transition(dt_s: float) -> FloatArray:
    """Shape (4, 4): takes x, y, vx, vy over an interval at constant velocity."""
    matrix = np.eye(4)
    matrix[0, 2] = matrix[1, 3] = dt_s
    return matrix


def process_noise(dt_s: float, acceleration_density: float) -> FloatArray:
    """Covariance that white-noise acceleration adds over an interval, shape (4, 4).

    The same matrix as FilterPy's `Q_continuous_white_noise(dim=2, block_size=2,
    order_by_dim=False)`, which the tests hold it against; two half intervals add up to the whole.

    Args:
        dt_s: The interval, from stamps.
        acceleration_density: Power spectral density, m^2/s^3.
    """
    position, mixed, velocity = dt_s**3 / 3, dt_s**2 / 2, dt_s
    matrix = np.zeros((4, 4))
    matrix[0, 0] = matrix[1, 1] = position
    matrix[0, 2] = matrix[2, 0] = matrix[1, 3] = matrix[3, 1] = mixed
    matrix[2, 2] = matrix[3, 3] = velocity
    return acceleration_density * matrix


def predict(
    mean: FloatArray, covariance: FloatArray, dt_s: float, acceleration_density: float
) -> tuple[FloatArray, FloatArray]:
    """Carry every track over an interval.

    Args:
        mean: Shape (N, 4): x_m, y_m, vx_mps, vy_mps.
        covariance: Shape (N, 4, 4).
        dt_s: The interval, from stamps.
        acceleration_density: Process noise, m^2/s^3.

    Returns:
        Prior mean and covariance, of the same shapes.
    """
    step = transition(dt_s)
    noise = process_noise(dt_s, acceleration_density)
    return mean @ step.T, step @ covariance @ step.T + noise
