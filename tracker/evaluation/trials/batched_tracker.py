"""Many trials at once, each with people of its own: who was measured, and where are they now?

The tracker's way of one frame (predict, gate, assign, correct) for people who are known from the
start and seen by one sensor at the origin: walkers at nearly constant velocity, Gaussian noise,
the most likely assignment. Trials lie along the last axis of every array and the numbers of a
state along the first, so that each operation runs through memory in one go.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment

from tracker.config import Config
from tracker.containers import BoolArray, FloatArray
from tracker.evaluation.metrics.constant_velocity import process_noise
from tracker.tracking.sensor_kinds import RANGE_FLOOR_M
from tracker.tracking.settings import gate_limit

_TURN = 2.0 * np.pi


class BatchedTracker:
    """Follows N people in each of B trials.

    Args:
        mean: Shape (4, N, B): x_m, y_m, vx_mps, vy_mps, the sensor standing at the origin.
        covariance: Shape (4, 4, N, B).
        config: `acceleration_density`, the gate, `detection_probability`, `newcomer_density`.
        bearing_std_rad: Noise of the bearings.
        range_std_m: Noise of the ranges.
    """

    def __init__(
        self,
        mean: FloatArray,
        covariance: FloatArray,
        config: Config,
        bearing_std_rad: float,
        range_std_m: float,
    ) -> None:
        self.mean = np.array(mean, dtype=np.float64)
        self.covariance = np.array(covariance, dtype=np.float64)
        self._config = config
        self._noise = (bearing_std_rad**2, range_std_m**2)

    def step(self, dt_s: float, bearing_rad: FloatArray, range_m: FloatArray) -> BoolArray:
        """Take in one frame of every trial.

        Args:
            dt_s: Since the last one.
            bearing_rad: Shape (M, B), in no order; NaN where a trial has fewer than M.
            range_m: Shape (M, B).

        Returns:
            Shape (M, N, B): which measurement each person got.
        """
        config = self._config
        numbers = (
            dt_s,
            config.acceleration_density,
            *self._noise,
            gate_limit(2, config.gate_probability),
            config.innovation_floor_m,
            _log_odds_offset(config),
        )
        chosen = np.zeros((len(bearing_rad), *self.mean.shape[1:]), dtype=bool)
        _frame(self.mean, self.covariance, bearing_rad, range_m, chosen, *numbers)
        return chosen


def assign_trials(gain: FloatArray, chosen: BoolArray) -> None:
    """Pair rows and columns of every trial one to one, at the highest sum of gains.

    Nearly always everybody's best is nobody else's; then nothing can be better. Only the other
    trials go through the Hungarian algorithm.

    Args:
        gain: Shape (M, N, B); a pair at 0 or below is not worth taking.
        chosen: Shape (M, N, B), filled in.
    """
    best = gain.max(axis=0)
    np.equal(gain, best, out=chosen)
    chosen &= best > 0.0
    counts = chosen.view(np.int8)
    is_disputed = (counts.sum(axis=1, dtype=np.int8) > 1).any(axis=0)
    is_disputed |= (counts.sum(axis=0, dtype=np.int8) > 1).any(axis=0)
    for trial in np.flatnonzero(is_disputed):
        own = np.maximum(gain[..., trial], 0.0)
        row, column = linear_sum_assignment(own, maximize=True)
        chosen[..., trial] = False
        chosen[row, column, trial] = own[row, column] > 0.0


def _log_odds_offset(config: Config) -> float:
    """What all pairs have in common of their log-odds against "missed, and somebody else's"."""
    chance = config.detection_probability
    return float(np.log(chance / (1.0 - chance) / config.newcomer_density / _TURN))


def _frame(
    mean: FloatArray,
    covariance: FloatArray,
    bearing_rad: FloatArray,
    range_m: FloatArray,
    chosen: BoolArray,
    dt_s: float,
    density: float,
    bearing_variance: float,
    range_variance: float,
    limit: float,
    floor_m: float,
    offset: float,
) -> None:
    mean[:2] += dt_s * mean[2:]
    covariance[:2] += dt_s * covariance[2:]
    covariance[:, :2] += dt_s * covariance[:, 2:]
    covariance += process_noise(dt_s, density)[..., None, None]

    # What the sensor would measure, its derivatives by x and y, and H P H'.
    x, y = mean[:2]
    distance = np.maximum(np.sqrt(x * x + y * y), RANGE_FLOOR_M)
    cos, sin = x / distance, y / distance
    turn_x, turn_y = -sin / distance, cos / distance
    by_bearing = covariance[:, 0] * turn_x + covariance[:, 1] * turn_y
    by_range = covariance[:, 0] * cos + covariance[:, 1] * sin
    own00 = turn_x * by_bearing[0] + turn_y * by_bearing[1]
    own01 = cos * by_bearing[0] + sin * by_bearing[1]
    own11 = cos * by_range[0] + sin * by_range[1]

    # Log-odds of every pair inside its gate.
    first = bearing_rad[:, None] - np.arctan2(y, x)
    first -= _TURN * np.rint(first / _TURN)
    second = range_m[:, None] - distance
    s00 = np.maximum(own00, floor_m**2 * (turn_x**2 + turn_y**2)) + bearing_variance
    s11 = np.maximum(own11, floor_m**2 * (cos**2 + sin**2)) + range_variance
    share = own01 / s00
    s_rest = s11 - share * own01
    gain = second - share * first
    gain *= gain
    gain /= s_rest
    gain += first * first / s00
    is_outside = ~(gain <= limit)
    gain *= -0.5
    gain += offset - 0.5 * np.log(s00 * s_rest)
    gain -= np.log(np.maximum(range_m, 0.1))[:, None]
    gain[is_outside] = 0.0
    assign_trials(gain, chosen)

    # x + W inv(L) y and P - W W', where S = L L' and W = P H' inv(L)'; 0 for whom nobody saw.
    is_seen = chosen.any(axis=0)
    first = np.where(chosen, first, 0.0).sum(axis=0)
    second = np.where(chosen, second, 0.0).sum(axis=0)
    l00 = np.sqrt(own00 + bearing_variance)
    l10 = own01 / l00
    l11 = np.sqrt(own11 + range_variance - l10 * l10)
    first /= l00
    second = (second - l10 * first) / l11
    by_bearing *= is_seen / l00
    by_range = (by_range * is_seen - l10 * by_bearing) / l11
    mean += by_bearing * first + by_range * second
    covariance -= by_bearing[:, None] * by_bearing
    covariance -= by_range[:, None] * by_range
