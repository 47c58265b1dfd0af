"""The tracker as in a textbook: read this first, then the product's own files.

One Kalman filter for each customer (FilterPy), one assignment for each frame (scipy), streaks that
say whose hand is up. With z a measured position, R its covariance, and x = (x, y, vx, vy):

    predict     x <- F x,  P <- F P F' + Q                       nearly constant velocity
    gate        y = z - H x,  S = H P H' + R:  y' inv(S) y <= chi-square quantile
    associate   maximize the sum of  log(Pd N(y; 0, S)) - log((1 - Pd) lambda)  over pairs
    correct     K = P H' inv(S),  x <- x + K y,  P <- (I - K H) P
    count       raised after 2 detections in a row, lowered after 3 misses (algorithm 1)
    renew       a hand of nobody known begins a customer; M of N frames confirm; silence deletes

The product does the same in its plain configuration, to rounding: the tests run both. Beyond that
it compares bearings and ranges where they were taken, doubts far ranges, lets people stand or
walk, weighs the assignment, knows existence, views, occlusion and bystanders, two hands of one
person, one person tracked twice, and lets those go who called but once or long ago.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np
from filterpy.common import Q_continuous_white_noise
from filterpy.kalman import KalmanFilter
from scipy.optimize import linear_sum_assignment
from scipy.stats import chi2

from tracker.config import Config
from tracker.containers import Measurements, SensorKind, Tracks, check_stamp
from tracker.errors import MeasurementError

#: A hand that was down in the last frame is up again in half of them (guess, as in the product).
RAISES_AGAIN = 0.5


@dataclass(eq=False)
class Customer:
    """One person whose hand has been up."""

    id: int
    kalman: KalmanFilter
    born_ns: int
    seen_ns: int
    recent: deque[bool]  # was a raised hand detected? In the last N frames, newest first
    detected: int = 0  # frames in a row
    missed: int = 0
    raised: bool = False
    raised_since_ns: int = -1
    confirmed: bool = False


class ReferenceTracker:
    """Positions and raised hands in, customers out.

    Args:
        config: `acceleration_density`, `gate_probability`, `detection_probability`,
            `newcomer_density`, `bystander_density`, `initial_speed_std_mps`, `raise_streak`,
            `lower_streak`, `confirm_detections`, `confirm_window`, `delete_after_s`. No other
            parameter changes anything here.
    """

    def __init__(self, config: Config | None = None) -> None:
        self._config = config or Config()
        self._limit = float(chi2.ppf(self._config.gate_probability, df=2))
        self._customers: list[Customer] = []
        self._next_id = 1
        self._stamp_ns = 0

    def step(self, stamp_ns: int, measurements: Measurements) -> Tracks:
        """Take in everything that was measured at one instant.

        Args:
            stamp_ns: Sensor time; one before the last means that everybody is forgotten first.
            measurements: Positions in the fixed frame. Raised hands create, correct and count;
                other positions only correct.

        Returns:
            Every customer, tentative ones too. Nobody is selected, and `existence` is 1.

        Raises:
            ClockError: The stamp is negative.
            MeasurementError: There are bearings or ranges among the measurements.
        """
        check_stamp(stamp_ns)
        _check_positions(measurements)
        if stamp_ns < self._stamp_ns:
            self._customers = []
        self._predict((stamp_ns - self._stamp_ns) / 1e9)
        self._stamp_ns = stamp_ns
        hands, others = measurements[measurements.raised], measurements[~measurements.raised]
        chance = [1.0 if customer.missed == 0 else RAISES_AGAIN for customer in self._customers]
        called = self._correct(hands, np.array(chance), self._config.newcomer_density)
        shown = self._correct(others, np.ones(len(chance)), self._config.bystander_density)
        for row, customer in enumerate(self._customers):
            if row in called or row in shown:
                customer.seen_ns = stamp_ns
            self._count(customer, row in called)
        for column in sorted(set(range(len(hands))) - set(called.values())):
            self._begin(hands.values[column], hands.covariance[column])
        self._customers = [one for one in self._customers if self._is_kept(one)]
        return self._tracks()

    def _predict(self, dt_s: float) -> None:
        transition = np.eye(4) + dt_s * np.eye(4, k=2)
        noise = Q_continuous_white_noise(
            2, dt_s, self._config.acceleration_density, block_size=2, order_by_dim=False
        )
        for customer in self._customers:
            customer.kalman.predict(F=transition, Q=noise)

    def _correct(
        self, measurements: Measurements, chance: np.ndarray, density: float
    ) -> dict[int, int]:
        """Associate and correct; the row of each measurement that was used, by its customer's."""
        odds = np.zeros((len(self._customers), len(measurements)))
        for row, customer in enumerate(self._customers):
            detected = self._config.detection_probability * chance[row]
            for column in range(len(measurements)):
                z, r = measurements.values[column], measurements.covariance[column]
                ratio = detected / ((1.0 - detected) * density)
                odds[row, column] = self._log_likelihood(customer.kalman, z, r) + np.log(ratio)
        odds = np.maximum(odds, 0.0)  # such a pair is better left alone
        pairs = zip(*linear_sum_assignment(odds, maximize=True), strict=True)
        used = {int(row): int(column) for row, column in pairs if odds[row, column] > 0.0}
        for row, column in used.items():
            z, r = measurements.values[column], measurements.covariance[column]
            self._customers[row].kalman.update(z, R=r)
        return used

    def _log_likelihood(self, kalman: KalmanFilter, z: np.ndarray, r: np.ndarray) -> float:
        """Of a measurement, were it this customer's; minus infinity outside the gate."""
        y, s = z - kalman.x[:2], kalman.P[:2, :2] + r
        distance = y @ np.linalg.solve(s, y)
        if distance > self._limit:
            return -np.inf
        return float(-0.5 * (distance + np.log(np.linalg.det(2.0 * np.pi * s))))

    def _count(self, customer: Customer, is_called: bool) -> None:
        """Streaks of the hand, and M of N."""
        was_raised = customer.raised
        customer.detected = customer.detected + 1 if is_called else 0
        customer.missed = 0 if is_called else customer.missed + 1
        customer.raised |= customer.detected >= self._config.raise_streak
        customer.raised &= customer.missed < self._config.lower_streak
        if customer.raised and not was_raised:
            customer.raised_since_ns = self._stamp_ns
        customer.recent.appendleft(is_called)
        customer.confirmed |= sum(customer.recent) >= self._config.confirm_detections

    def _begin(self, z: np.ndarray, r: np.ndarray) -> None:
        """A newcomer stands where the hand is, as far as we know."""
        kalman = KalmanFilter(dim_x=4, dim_z=2)
        kalman.x = np.array([*z, 0.0, 0.0])
        kalman.H = np.eye(2, 4)
        kalman.P = np.diag([0.0, 0.0, 1.0, 1.0]) * self._config.initial_speed_std_mps**2
        kalman.P[:2, :2] = r
        recent = deque([False] * self._config.confirm_window, self._config.confirm_window)
        customer = Customer(self._next_id, kalman, self._stamp_ns, self._stamp_ns, recent)
        self._count(customer, is_called=True)
        self._customers.append(customer)
        self._next_id += 1

    def _is_kept(self, customer: Customer) -> bool:
        """Confirmed and not silent for long, or tentative and still able to be confirmed."""
        if customer.confirmed:
            silent_s = (self._stamp_ns - customer.seen_ns) / 1e9
            return silent_s <= self._config.delete_after_s
        recent, window = list(customer.recent), self._config.confirm_window
        left = [sum(recent[: window - fresh]) for fresh in range(1, window)]
        needed = self._config.confirm_detections
        return any(kept and kept + fresh >= needed for fresh, kept in enumerate(left, start=1))

    def _tracks(self) -> Tracks:
        def column(name: str) -> np.ndarray:
            return np.array([getattr(one, name) for one in self._customers])

        count = len(self._customers)
        kalmans = [one.kalman for one in self._customers]
        return Tracks(
            stamp_ns=self._stamp_ns,
            id=column("id").astype(np.int64),
            mean=np.reshape([kalman.x for kalman in kalmans], (count, 4)),
            covariance=np.reshape([kalman.P for kalman in kalmans], (count, 4, 4)),
            existence=np.ones(count),
            confirmed=column("confirmed").astype(bool),
            raised=column("raised").astype(bool),
            raised_since_ns=column("raised_since_ns").astype(np.int64),
            age_s=(self._stamp_ns - column("born_ns")) / 1e9,
            unseen_s=(self._stamp_ns - column("seen_ns")) / 1e9,
            hand=np.full(count, -1),
        )


def _check_positions(measurements: Measurements) -> None:
    others = np.count_nonzero(measurements.kind != SensorKind.POSITION)
    if others:
        raise MeasurementError(
            f"{others} of {len(measurements)} measurements are bearings or ranges; the reference "
            "tracker takes only positions. Give it `as_positions` of them, or use PersonTracker."
        )
