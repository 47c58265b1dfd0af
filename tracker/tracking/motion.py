"""How do people move between two stamps? They walk at nearly constant velocity, or they stand.

Walking is white-noise acceleration. Standing is a speed that keeps returning to zero (an
Ornstein-Uhlenbeck process), so that somebody who stands does not drift off while nobody looks.
Both are exact over any interval: two half steps equal a whole one.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from tracker.config import Config
from tracker.containers import FloatArray

#: How fast the sway of somebody who stands is forgotten (guess).
STAND_MEMORY_S = 0.5


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """What one interval does to each of K modes.

    Attributes:
        transition: Shape (K, 4, 4): takes x, y, vx, vy over the interval.
        noise: Shape (K, 4, 4): covariance that the interval adds.
        switching: Shape (K, K): probability of mode j after the interval, given mode i before.
    """

    transition: FloatArray
    noise: FloatArray
    switching: FloatArray

    @property
    def modes(self) -> int:
        """K."""
        return len(self.transition)


def motion_over(dt_s: float, config: Config) -> Motion:
    """The configured motion over an interval: modes (walk,) or (walk, stand)."""
    return _motion_over(
        dt_s,
        config.motion == "imm",
        config.acceleration_density,
        config.stand_speed_std_mps,
        config.stand_duration_s,
        config.walk_duration_s,
    )


def transition(dt_s: float) -> FloatArray:
    """Shape (4, 4): takes x, y, vx, vy over an interval at constant velocity."""
    matrix = np.eye(4)
    matrix[0, 2] = matrix[1, 3] = dt_s
    return matrix


def modes_of(config: Config) -> int:
    """How many modes of motion people have: one, or two where they may stand."""
    return 2 if config.motion == "imm" else 1


def process_noise(dt_s: float, acceleration_density: float) -> FloatArray:
    """Covariance that white-noise acceleration adds over an interval, shape (4, 4).

    The same matrix as FilterPy's `Q_continuous_white_noise(dim=2, block_size=2,
    order_by_dim=False)`, which the tests hold it against; two half intervals add up to the whole.

    Args:
        dt_s: The interval, from stamps.
        acceleration_density: Power spectral density, m^2/s^3.
    """
    return acceleration_density * _both_axes(dt_s**3 / 3, dt_s**2 / 2, dt_s)


def stand_transition(dt_s: float, memory_s: float = STAND_MEMORY_S) -> FloatArray:
    """Shape (4, 4): the speed fades, and the position moves by what is left of it."""
    fade = np.exp(-dt_s / memory_s)
    matrix = np.diag([1.0, 1.0, fade, fade])
    matrix[0, 2] = matrix[1, 3] = memory_s * (1.0 - fade)
    return matrix


def stand_noise(dt_s: float, speed_std_mps: float, memory_s: float = STAND_MEMORY_S) -> FloatArray:
    """Covariance that swaying adds over an interval, shape (4, 4); the speed's stays bounded."""
    lapse = -np.expm1(-dt_s / memory_s)
    # 2 t - 3 + 4 exp(-t) - exp(-2 t) without its cancellation, where t is short.
    position = 2.0 * (dt_s / memory_s - lapse) - lapse**2
    if dt_s < 1e-3 * memory_s:
        position = 2.0 / 3.0 * (dt_s / memory_s) ** 3
    return speed_std_mps**2 * _both_axes(
        memory_s**2 * position, memory_s * lapse**2, lapse * (2.0 - lapse)
    )


def predict(
    mean: FloatArray, covariance: FloatArray, dt_s: float, acceleration_density: float
) -> tuple[FloatArray, FloatArray]:
    """Carry every track over an interval at nearly constant velocity.

    Args:
        mean: Shape (..., N, 4): x_m, y_m, vx_mps, vy_mps.
        covariance: Shape (..., N, 4, 4).
        dt_s: The interval, from stamps.
        acceleration_density: Process noise, m^2/s^3.

    Returns:
        Prior mean and covariance, of the same shapes.
    """
    noise = process_noise(dt_s, acceleration_density)
    walk = Motion(transition(dt_s)[None], noise[None], np.eye(1))
    mean, covariance = carry(mean[..., None, :, :], covariance[..., None, :, :, :], walk)
    return mean[..., 0, :, :], covariance[..., 0, :, :, :]


def carry(
    mean: FloatArray, covariance: FloatArray, motion: Motion
) -> tuple[FloatArray, FloatArray]:
    """F x and F P F' + Q of every mode.

    One small product for each track, so that no last bit depends on how many there are.

    Args:
        mean: Shape (..., K, N, 4).
        covariance: Shape (..., K, N, 4, 4).
        motion: K modes.
    """
    step = motion.transition[:, None]
    carried = (step @ mean[..., None])[..., 0]
    spread = step @ covariance @ np.swapaxes(step, -1, -2)
    spread += motion.noise[:, None]
    return carried, spread


def _both_axes(position: float, mixed: float, velocity: float) -> FloatArray:
    matrix = np.zeros((4, 4))
    matrix[0, 0] = matrix[1, 1] = position
    matrix[0, 2] = matrix[2, 0] = matrix[1, 3] = matrix[3, 1] = mixed
    matrix[2, 2] = matrix[3, 3] = velocity
    return matrix


@lru_cache(maxsize=32)  # most intervals are the camera's period
def _motion_over(
    dt_s: float,
    stands: bool,
    acceleration_density: float,
    stand_speed_std_mps: float,
    stand_duration_s: float,
    walk_duration_s: float,
) -> Motion:
    walk, walk_noise = transition(dt_s), process_noise(dt_s, acceleration_density)
    if not stands:
        return Motion(walk[None], walk_noise[None], np.eye(1))
    # A Markov chain in continuous time, so that the switching too depends on the interval alone.
    stop, start = 1.0 / walk_duration_s, 1.0 / stand_duration_s
    share = -np.expm1(-(stop + start) * dt_s) / (stop + start)
    return Motion(
        np.stack([walk, stand_transition(dt_s)]),
        np.stack([walk_noise, stand_noise(dt_s, stand_speed_std_mps)]),
        np.array([[1.0 - stop * share, stop * share], [start * share, 1.0 - start * share]]),
    )
