"""The whole tracker in one call: measurements of an instant in, everybody's state out."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tracker.config import Config
from tracker.containers import (
    BoolArray,
    FloatArray,
    IntArray,
    MeasurementModel,
    Measurements,
    Tracks,
    check_stamp,
)
from tracker.tracking.association import associate
from tracker.tracking.filter import initial_state, innovations, update
from tracker.tracking.life_cycle import (
    BIRTH_EXISTENCE,
    count_detections,
    fade_existence,
    still_there,
)
from tracker.tracking.motion import predict
from tracker.tracking.people import People
from tracker.tracking.selection import Selector

#: Farther than this from the fixed frame's origin there is no person, and less or more than these
#: variances no sensor claims; beyond them squares overflow.
_ABSURD_M = 1e6
_VARIANCE_MIN, _VARIANCE_MAX = 1e-12, 1e9


class PersonTracker:
    """Kalman-filtered customers, from raised hands and the people in the scan.

    Raised hands create customers and feed their streaks; everything else only sustains and refines
    those who are there. Identities count from 1 and are never reused by one tracker.

    Args:
        config: The tracking and selection groups.
    """

    def __init__(self, config: Config | None = None) -> None:
        self._config = config or Config()
        self._next_id = 1
        self._stamp_ns: int | None = None
        self._people = People.nobody(self._config.confirm_window)
        self.selector = Selector(self._config)

    @property
    def config(self) -> Config:
        """The parameters in force; setting them keeps the tracks."""
        return self._config

    @config.setter
    def config(self, config: Config) -> None:
        if config.confirm_window != self._config.confirm_window:
            held = self._people.recent[:, : config.confirm_window]
            recent = np.zeros((len(held), config.confirm_window), dtype=bool)
            recent[:, : held.shape[1]] = held
            self._people = self._people.replace(recent=recent)
        self._config = self.selector.config = config

    @property
    def has_tracks(self) -> bool:
        """Whether anybody is tracked now."""
        return len(self._people) > 0

    def reset(self) -> None:
        """Forget everybody; identities go on counting."""
        self._people = People.nobody(self._config.confirm_window)
        self._stamp_ns = None
        self.selector.reset()

    def step(
        self, stamp_ns: int, measurements: Measurements, robot_xy_m: ArrayLike = (0.0, 0.0)
    ) -> Tracks:
        """Take in everything that was measured at one instant.

        A stamp before the last one means that the clock has jumped: everybody is forgotten first.
        Measurements that are not finite, or whose covariance is none, are passed over.

        Args:
            stamp_ns: Sensor time of the measurements.
            measurements: In the fixed frame; may be empty.
            robot_xy_m: Shape (2,): where the robot is, for `selection: nearest`.

        Returns:
            Everybody, tentative ones included (`confirmed` tells), with the selected customer.

        Raises:
            ClockError: The stamp is negative.
        """
        check_stamp(stamp_ns)
        if self._stamp_ns is not None and stamp_ns < self._stamp_ns:
            self.reset()
        people = self._predict(stamp_ns)
        measurements = measurements[_usable(measurements)]

        raised = _once_per_person(measurements[measurements.raised], self._config)
        people, called_by = self._update(people, raised)
        others = measurements[~measurements.raised]
        people, shown_by = self._update(people, others)
        is_called = called_by >= 0
        hand = np.where(is_called, _hands_of(raised, called_by), _hands_of(others, shown_by))
        people = people.replace(hand=hand)

        newcomers = self._newcomers(people, is_called, raised, called_by, stamp_ns)
        people = people.append(newcomers)
        is_called = np.append(is_called, np.ones(len(newcomers), dtype=bool))
        is_seen = is_called | np.append(shown_by >= 0, np.ones(len(newcomers), dtype=bool))
        people = count_detections(people, is_called, is_seen, stamp_ns, self._config)
        people = people[still_there(people, stamp_ns, self._config)]

        self._people, self._stamp_ns = people, stamp_ns
        tracks = people.as_tracks(stamp_ns)
        chosen = self.selector.choose(tracks, np.asarray(robot_xy_m, dtype=np.float64))
        return people.as_tracks(stamp_ns, selected_id=chosen)

    def _predict(self, stamp_ns: int) -> People:
        people = self._people
        if self._stamp_ns is None or len(people) == 0:
            return people
        dt_s = (stamp_ns - self._stamp_ns) / 1e9
        # Beyond the longest memory everybody is gone anyway; a day's gap must not overflow.
        dt_s = min(dt_s, 10.0 * self._config.delete_after_s)
        mean, covariance = predict(
            people.mean, people.covariance, dt_s, self._config.acceleration_density
        )
        people = people.replace(mean=mean, covariance=covariance)
        return fade_existence(people, dt_s, self._config)

    def _update(self, people: People, claims: Measurements) -> tuple[People, IntArray]:
        innovation, spread = innovations(people.mean, people.covariance, claims)
        chosen = associate(innovation, spread, claims, self._config.gate_probability)
        rows = np.flatnonzero(chosen >= 0)
        if len(rows) == 0:
            return people, chosen
        mean, covariance = people.mean.copy(), people.covariance.copy()
        mean[rows], covariance[rows] = update(
            people.mean[rows], people.covariance[rows], claims[chosen[rows]]
        )
        return people.replace(mean=mean, covariance=covariance), chosen

    def _newcomers(
        self,
        people: People,
        is_called: BoolArray,
        raised: Measurements,
        called_by: IntArray,
        stamp_ns: int,
    ) -> People:
        """People behind raised hands that belong to nobody known."""
        left = raised[np.setdiff1d(np.arange(len(raised)), called_by)]
        mean, covariance = initial_state(
            left,
            unknown_range_m=self._config.unknown_range_m,
            unknown_range_std_m=self._config.unknown_range_std_m,
            speed_std_mps=self._config.initial_speed_std_mps,
        )
        # The second hand of somebody whose first hand has just been counted is nobody new.
        second = _is_near(mean[:, :2], people.mean[is_called, :2], self._config)
        mean, covariance, left = mean[~second], covariance[~second], left[~second]
        ids = np.arange(self._next_id, self._next_id + len(mean), dtype=np.int64)
        self._next_id += len(mean)
        window = self._config.confirm_window
        newcomers = People.begin(ids, mean, covariance, stamp_ns, window, BIRTH_EXISTENCE)
        return newcomers.replace(hand=left.hand)


def _usable(measurements: Measurements) -> BoolArray:
    """Rows that a filter can live with: sane numbers, a positive definite covariance."""
    values, covariance = measurements.values, measurements.covariance
    polar = measurements.model == MeasurementModel.POLAR
    bearing_only = polar & np.isnan(values[:, 1])
    sane = (np.abs(values[:, 0]) < _ABSURD_M) & (np.abs(measurements.sensor_pose) < _ABSURD_M).all(
        1
    )
    sane &= bearing_only | (np.abs(values[:, 1]) < _ABSURD_M)
    sane &= ~(polar & (values[:, 1] < 0.0))
    variances = covariance[:, [0, 1], [0, 1]]
    sane &= ((variances > _VARIANCE_MIN) & (variances < _VARIANCE_MAX)).all(axis=1)
    # The correlation must be below one, with room for rounding; NaN compares as false throughout.
    spread = np.sqrt(np.where(sane[:, None], variances, 1.0)).prod(axis=1)
    mixed = np.abs(covariance[:, [0, 1], [1, 0]])
    sane &= (mixed < (1.0 - 1e-9) * spread[:, None]).all(axis=1)
    return np.asarray(sane & (np.abs(covariance[:, 0, 1] - covariance[:, 1, 0]) <= 1e-9 * spread))


def _once_per_person(raised: Measurements, config: Config) -> Measurements:
    """Two raised hands of one person count once: the first row of each person stays."""
    _, first = np.unique(raised.person, return_index=True)
    keep = (raised.person < 0) | np.isin(np.arange(len(raised)), first)
    raised = raised[keep]
    mean, _ = initial_state(
        raised,
        unknown_range_m=config.unknown_range_m,
        unknown_range_std_m=config.unknown_range_std_m,
        speed_std_mps=config.initial_speed_std_mps,
    )
    keep = np.ones(len(raised), dtype=bool)
    for row in range(1, len(raised)):
        earlier = mean[:row][keep[:row]]
        keep[row] = not _is_near(mean[row : row + 1, :2], earlier[:, :2], config)[0]
    return raised[keep]


def _is_near(xy_m: FloatArray, others_m: FloatArray, config: Config) -> BoolArray:
    distance = np.linalg.norm(xy_m[:, None] - others_m[None], axis=-1)
    return np.asarray((distance < config.same_person_distance_m).any(axis=1))


def _hands_of(claims: Measurements, chosen: IntArray) -> IntArray:
    hands = np.append(claims.hand, -1)  # row -1 answers for tracks without a claim
    return np.asarray(hands[chosen])
