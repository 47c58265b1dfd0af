"""The whole tracker in one call: measurements of an instant in, everybody's state out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, IntArray, Measurements, Tracks, check_stamp
from tracker.tracking.admission import is_close, once_per_person, usable, with_hand_bias
from tracker.tracking.appearance import Appearance, recognizable
from tracker.tracking.association import assign, log_odds
from tracker.tracking.converted import convert
from tracker.tracking.filter import initial_state
from tracker.tracking.gating import find_pairs
from tracker.tracking.joint_probability import marginals
from tracker.tracking.life_cycle import (
    BIRTH_EXISTENCE,
    believe,
    count_detections,
    fade,
    still_there,
)
from tracker.tracking.modes import Belief, predict_modes
from tracker.tracking.motion import motion_over
from tracker.tracking.people import People
from tracker.tracking.posterior import update_assigned, update_jointly
from tracker.tracking.selection import Selector
from tracker.tracking.twins import merge_twins
from tracker.tracking.view import View, visibility

#: Of a raised hand, the chance that one counts whose owner had it down in the last frame (guess).
_RAISES_AGAIN = 0.5
#: Nobody is ever certain to be detected, or certain not to be.
_DETECTION_MIN = 0.02


class PersonTracker:
    """Kalman-filtered customers, from raised hands and the people in the scan.

    Raised hands create customers and feed their streaks; everything else only sustains and refines
    those who are there. Bystanders, whom only the scan shows, are followed within: what is known
    to be somebody else's is not taken for a customer's. Identities count from 1 and are never
    reused by one tracker.

    Args:
        config: The tracking and selection groups.
    """

    def __init__(self, config: Config | None = None) -> None:
        self._config = config or Config()
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
        raised, others = self._admit(measurements, dt_s)

        people, in_camera, in_view = self._predict(dt_s, view, scan_view)
        hand_chance = np.where(people.streaks.missed == 0, 1.0, _RAISES_AGAIN)
        belief, existence, called_by = self._update(
            people.belief, people.existence, people.appearance, raised, in_camera * hand_chance
        )
        belief, existence, shown_by = self._update(
            belief, existence, people.appearance, others, in_view
        )
        is_called, is_shown = called_by >= 0, shown_by >= 0
        is_seen = is_called | is_shown
        hand = np.full(len(people), -1, dtype=np.int64)
        hand[is_shown] = others.hand[shown_by[is_shown]]
        hand[is_called] = raised.hand[called_by[is_called]]

        people = count_detections(
            people,
            is_called,
            is_seen,
            stamp_ns,
            self._config,
            belief=belief,
            existence=existence,
            hand=hand,
            id=self._ids(people, is_called),
            appearance=people.appearance.remember(raised.appearance, called_by).remember(
                others.appearance, shown_by
            ),
        )
        place = belief.merged()[0][:, :2]
        if np.count_nonzero(is_shown) < len(others):
            bystanders = self._bystanders(others, shown_by, place[is_seen], stamp_ns)
            people = people.append(bystanders)
            is_seen = np.append(is_seen, np.ones(len(bystanders), dtype=bool))
        people = merge_twins(people, is_seen, self._config)
        if np.count_nonzero(is_called) < len(raised):
            people = people.append(self._newcomers(raised, called_by, place[is_called], stamp_ns))
        keep = still_there(people, stamp_ns, self._config)
        if not keep.all():
            people = people[keep]

        self._people, self._stamp_ns = people, stamp_ns
        robot_xy = np.asarray(robot_xy_m, dtype=np.float64)
        customers = people.customers()
        return customers.as_tracks(stamp_ns, self.selector.choose(customers, stamp_ns, robot_xy))

    def _nobody(self) -> People:
        return People.nobody(self._config.confirm_window, _modes(self._config))

    def _admit(self, measurements: Measurements, dt_s: float) -> tuple[Measurements, Measurements]:
        """Raised hands, one per person, and everything else."""
        sane = usable(measurements)
        if not sane.all():
            measurements = measurements[sane]
        if measurements.appearance is not None:
            looks = (
                recognizable(measurements.appearance) if self._config.appearance_weight else None
            )
            measurements = replace(measurements, appearance=looks)
        if self._config.measurement_model == "converted":
            measurements = convert(measurements)
        raised, others = measurements, _NOTHING
        if not measurements.raised.all():
            raised, others = measurements[measurements.raised], measurements[~measurements.raised]
        raised = once_per_person(raised, self._config)
        return with_hand_bias(raised, dt_s, self._config), others

    def _predict(
        self, dt_s: float, view: View | None, scan_view: View | None
    ) -> tuple[People, FloatArray, FloatArray]:
        """Everybody at this instant; visible to the camera, and to anything."""
        people = self._people
        belief = predict_modes(people.belief, motion_over(dt_s, self._config))
        in_camera = np.ones(len(people))
        if view is not None or scan_view is not None:
            xy_m = belief.merged()[0][:, :2]
            in_camera = visibility(xy_m, view)
        in_view = in_camera
        if scan_view is not None:
            in_view = np.maximum(in_camera, visibility(xy_m, scan_view))
        return fade(people, belief, dt_s, in_view, self._config), in_camera, in_view

    def _update(
        self,
        belief: Belief,
        existence: FloatArray,
        appearance: Appearance,
        claims: Measurements,
        visible: FloatArray,
    ) -> tuple[Belief, FloatArray, IntArray]:
        """Associate and correct; also says which measurement each track got, or -1."""
        got = np.full(len(existence), -1, dtype=np.int64)
        if len(existence) == 0 or len(claims) == 0:
            return belief, existence, got
        pairs = find_pairs(belief, claims, self._config)
        chance = np.maximum(visible * self._config.detection_probability, _DETECTION_MIN)
        odds = log_odds(pairs, belief.weight, chance)
        if claims.appearance is not None:
            clothes = appearance.log_ratio(claims.appearance, pairs.track, pairs.claim)
            odds += self._config.appearance_weight * clothes
        chosen = assign(pairs, odds, len(existence))
        rows = np.flatnonzero(chosen >= 0)
        hits = chosen[rows]
        if self._config.association == "jpda":
            belief = update_jointly(belief, pairs, marginals(pairs.track, pairs.claim, odds))
        else:
            belief = update_assigned(belief, pairs if len(hits) == len(pairs) else pairs[hits])
        got[rows] = pairs.claim[hits]
        evidence = np.zeros(len(existence))
        evidence[rows] = odds[hits] + np.log(1.0 - chance[rows])
        return belief, believe(existence, evidence), got

    def _ids(self, people: People, is_called: BoolArray) -> IntArray:
        """Bystanders who raise a hand become customers."""
        new = is_called & ~people.is_customer
        if not new.any():
            return people.id
        ids: IntArray = people.id.copy()
        ids[new] = self._next_ids(int(np.count_nonzero(new)))
        return ids

    def _next_ids(self, count: int) -> IntArray:
        first, self._next_id = self._next_id, self._next_id + count
        return np.arange(first, self._next_id, dtype=np.int64)

    def _newcomers(
        self, raised: Measurements, called_by: IntArray, called_xy_m: FloatArray, stamp_ns: int
    ) -> People:
        """People behind raised hands that belong to nobody known."""
        # The second hand of somebody whose first hand has just been counted is nobody new.
        people, left = self._begin(raised, called_by, called_xy_m, stamp_ns)
        people = people.replace(id=self._next_ids(len(people)))
        everyone = np.ones(len(people), dtype=bool)
        return count_detections(people, everyone, everyone, stamp_ns, self._config, hand=left.hand)

    def _bystanders(
        self, others: Measurements, shown_by: IntArray, seen_xy_m: FloatArray, stamp_ns: int
    ) -> People:
        """Whoever else the scan shows; a lowered hand alone is nobody."""
        # A second cluster beside somebody seen is their other leg.
        people, left = self._begin(others, shown_by, seen_xy_m, stamp_ns)
        return people[left.hand < 0]

    def _begin(
        self, claims: Measurements, taken: IntArray, seen_xy_m: FloatArray, stamp_ns: int
    ) -> tuple[People, Measurements]:
        """Nobody's claims, apart from the people seen already, and the people behind them."""
        config = self._config
        is_left = np.ones(len(claims), dtype=bool)
        is_left[taken[taken >= 0]] = False
        left = claims[is_left]
        mean, covariance = initial_state(
            left,
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
        looks = None if left.appearance is None else left.appearance[new]
        appearance = Appearance.unknown(count).remember(looks, np.arange(count))
        people = People.begin(ids, belief, stamp_ns, config.confirm_window, existence, appearance)
        return people, left[new]


_NOTHING = Measurements.none()


def _modes(config: Config) -> int:
    return 2 if config.motion == "imm" else 1
