"""Nearly constant velocity as matrices, for bounds and for drawing what happens."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray
from tracker.tracking.prediction.motion import walk


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
    _, _, position, mixed, velocity = walk(dt_s, acceleration_density)
    matrix = np.diag([position, position, velocity, velocity])
    matrix[[0, 1, 2, 3], [2, 3, 0, 1]] = mixed
    return matrix
