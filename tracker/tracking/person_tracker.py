"""The whole tracker in one call: measurements of an instant in, everybody's state out."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial

import numpy as np
from numpy.typing import ArrayLike

from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, IntArray, Measurements, Tracks, check_stamp
from tracker.tracking import frame
from tracker.tracking.admission import is_close
from tracker.tracking.appearance import Appearance
from tracker.tracking.filter import initial_state
from tracker.tracking.innovations import Watch
from tracker.tracking.life_cycle import BIRTH_EXISTENCE, count_detections, still_there
from tracker.tracking.modes import Belief
from tracker.tracking.people import People
from tracker.tracking.selection import Selector
from tracker.tracking.twins import merge_twins
from tracker.tracking.view import View


class PersonTracker:
    """Kalman-filtered customers, from raised hands and the people in the scan.

    Raised hands create customers and feed their streaks; everything else only sustains and refines
    those who are there. Bystanders, whom only the scan shows, are followed within: what is known
    to be somebody else's is not taken for a customer's. Identities count from 1 and are never
    reused by one tracker.

    Args:
        config: The tracking and selection groups.
        watch: Told of every round of association, before it counts; see `tracking.innovations`.
        compiled: Let numba (the extra `fast`) do a frame's work, if it is installed and nobody
            watches; the numbers are the same up to rounding.
    """

    def __init__(
        self,
        config: Config | None = None,
        *,
        watch: Watch | None = None,
        compiled: bool = True,
    ) -> None:
        self._config = config or Config()
        self._observe: Callable[..., frame.Observed] = partial(frame.observe, watch=watch)
        if compiled and watch is None:
            self._observe = _compiled_observe() or frame.observe
        self._next_id = 1
        self._stamp_ns: int | None = None
        self._people = self._nobody()
        self.selector = Selector(self._config)

    @property
    def config(self) -> Config:
        """The parameters in force; setting them keeps the tracks."""
        return self._config

    @config.setter
    def config(self, config: Config) -> None:
        people = self._people
        if config.confirm_window != self._config.confirm_window:
            held = people.recent[:, : config.confirm_window]
            recent = np.zeros((len(held), config.confirm_window), dtype=bool)
            recent[:, : held.shape[1]] = held
            people = people.replace(recent=recent)
        belief = people.belief.with_modes(_modes(config), config.stand_speed_std_mps)
        self._people = people.replace(belief=belief)
        self._config = self.selector.config = config

    @property
    def has_tracks(self) -> bool:
        """Whether anybody is tracked now."""
        return bool(self._people.is_customer.any())

    @property
    def positions_m(self) -> FloatArray:
        """Shape (N, 2): where everybody was at the last step, in the fixed frame."""
        return self._people.belief.merged()[0][:, :2]

    def reset(self) -> None:
        """Forget everybody; identities go on counting."""
        self._people = self._nobody()
        self._stamp_ns = None
        self.selector.reset()

    def step(
        self,
        stamp_ns: int,
        measurements: Measurements,
        robot_xy_m: ArrayLike = (0.0, 0.0),
        *,
        view: View | None = None,
        scan_view: View | None = None,
    ) -> Tracks:
        """Take in everything that was measured at one instant.

        A stamp before the last one means that the clock has jumped: everybody is forgotten first.
        Measurements that are not finite, or whose covariance is none, are passed over.

        Args:
            stamp_ns: Sensor time of the measurements.
            measurements: In the fixed frame; may be empty.
            robot_xy_m: Shape (2,): where the robot is, for `selection: nearest`.
            view: Where the camera could see hands; None means everywhere.
            scan_view: Where the scan could show people; None where there is no scan.

        Returns:
            Everybody, tentative ones included (`confirmed` tells), with the selected customer.

        Raises:
            ClockError: The stamp is negative.
        """
        check_stamp(stamp_ns)
        if self._stamp_ns is not None and stamp_ns < self._stamp_ns:
            self.reset()
        dt_s = 0.0 if self._stamp_ns is None else (stamp_ns - self._stamp_ns) / 1e9
        # Beyond the longest memory everybody is gone anyway; a day's gap must not overflow.
        dt_s = min(dt_s, 10.0 * max(self._config.delete_after_s, self._config.forget_after_s))
        seen = self._observe(
            self._people, measurements, dt_s, stamp_ns, self._config, view, scan_view
        )
        people, is_seen = self._with_ids(seen.people, seen.is_called), seen.is_seen
        keep = seen.stay
        if people is not seen.people or seen.may_be_twice or len(seen.raised) or len(seen.others):
            place = people.belief.merged()[0][:, :2]
            if len(seen.others):
                bystanders = self._bystanders(seen.others, place[is_seen], stamp_ns)
                people = people.append(bystanders)
                is_seen = np.append(is_seen, np.ones(len(bystanders), dtype=bool))
            people = merge_twins(people, is_seen, self._config)
            if len(seen.raised):
                newcomers = self._newcomers(seen.raised, place[seen.is_called], stamp_ns)
                people = people.append(newcomers)
            keep = still_there(people, stamp_ns, self._config)
        if not keep.all():
            people = people[keep]

        self._people, self._stamp_ns = people, stamp_ns
        robot_xy = np.asarray(robot_xy_m, dtype=np.float64)
        customers = people.customers()
        return customers.as_tracks(stamp_ns, self.selector.choose(customers, stamp_ns, robot_xy))

    def _nobody(self) -> People:
        return People.nobody(self._config.confirm_window, _modes(self._config))

    def _with_ids(self, people: People, is_called: BoolArray) -> People:
        """Bystanders who raise a hand become customers."""
        new = is_called & ~people.is_customer
        if not new.any():
            return people
        ids: IntArray = people.id.copy()
        ids[new] = self._next_ids(int(np.count_nonzero(new)))
        return people.replace(id=ids)

    def _next_ids(self, count: int) -> IntArray:
        first, self._next_id = self._next_id, self._next_id + count
        return np.arange(first, self._next_id, dtype=np.int64)

    def _newcomers(self, raised: Measurements, called_xy_m: FloatArray, stamp_ns: int) -> People:
        """People behind raised hands that belong to nobody known."""
        # The second hand of somebody whose first hand has just been counted is nobody new.
        people, left = self._begin(raised, called_xy_m, stamp_ns)
        people = people.replace(id=self._next_ids(len(people)))
        everyone = np.ones(len(people), dtype=bool)
        return count_detections(people, everyone, everyone, stamp_ns, self._config, hand=left.hand)

    def _bystanders(self, others: Measurements, seen_xy_m: FloatArray, stamp_ns: int) -> People:
        """Whoever else the scan shows; a lowered hand alone is nobody."""
        # A second cluster beside somebody seen is their other leg.
        people, left = self._begin(others, seen_xy_m, stamp_ns)
        return people[left.hand < 0]

    def _begin(
        self, claims: Measurements, seen_xy_m: FloatArray, stamp_ns: int
    ) -> tuple[People, Measurements]:
        """The people behind claims, apart from those seen already, and their claims."""
        config = self._config
        mean, covariance = initial_state(
            claims,
            unknown_range_m=config.unknown_range_m,
            unknown_range_std_m=config.unknown_range_std_m,
            speed_std_mps=config.initial_speed_std_mps,
        )
        new = ~is_close(mean[:, :2], seen_xy_m, config.same_person_distance_m).any(axis=1)
        belief = Belief.begin(
            mean[new], covariance[new], _modes(config), config.stand_speed_std_mps
        )
        count = int(np.count_nonzero(new))
        ids, existence = np.zeros(count, dtype=np.int64), np.full(count, BIRTH_EXISTENCE)
        looks = None if claims.appearance is None else claims.appearance[new]
        appearance = Appearance.unknown(count).remember(looks, np.arange(count))
        people = People.begin(ids, belief, stamp_ns, config.confirm_window, existence, appearance)
        return people, claims[new]


def _modes(config: Config) -> int:
    return 2 if config.motion == "imm" else 1


@cache
def _compiled_observe() -> Callable[..., frame.Observed] | None:
    try:
        from tracker.tracking.compiled.frame import observe
    except ModuleNotFoundError as error:
        if error.name != "numba":
            raise
        return None
    return observe
