"""The whole tracker in one call: measurements of an instant in, everybody's state out."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from tracker.config import Config
from tracker.containers import FloatArray, Measurements, Tracks, check_stamp
from tracker.tracking.frame import track
from tracker.tracking.innovations import Watch
from tracker.tracking.modes import Belief
from tracker.tracking.motion import modes_of
from tracker.tracking.people import People
from tracker.tracking.selection import Selector
from tracker.tracking.streaks import Streaks
from tracker.tracking.view import View

if TYPE_CHECKING:
    from tracker.tracking.compiled.frame import CompiledTrack


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
        self._track: Callable[..., tuple[People, int]] = partial(track, watch=watch)
        if compiled and watch is None:
            compiled_track = _compiled_track()
            self._track = compiled_track() if compiled_track is not None else track
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
        belief = people.belief.with_modes(modes_of(config), config.stand_speed_std_mps)
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

    def lower_hands(self) -> None:
        """Let every hand count as down until it is seen up again; identities stay."""
        self._people = self._people.replace(streaks=Streaks.begin(len(self._people)))

    def doubt(self, moved: FloatArray, over_s: float) -> None:
        """Widen what is believed of everybody by a motion that they may be off by.

        Args:
            moved: Shape (3,): x_m, y_m, yaw_rad of a rigid motion about the origin, such as the
                camera's while it was supposed to stand still.
            over_s: In which time.
        """
        belief = self._people.belief
        cos, sin = np.cos(moved[2]), np.sin(moved[2])
        here_m = belief.mean[..., :2]
        off_m = here_m @ np.array([[cos, sin], [-sin, cos]]) + moved[:2] - here_m
        off = np.concatenate([off_m, off_m / max(over_s, 1e-3)], axis=-1)
        wider = belief.covariance + off[..., :, None] * off[..., None, :]
        self._people = self._people.replace(belief=Belief(belief.weight, belief.mean, wider))

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
        people, self._next_id = self._track(
            self._people,
            measurements,
            self._next_id,
            dt_s,
            stamp_ns,
            self._config,
            view,
            scan_view,
        )
        self._people, self._stamp_ns = people, stamp_ns
        robot_xy = np.asarray(robot_xy_m, dtype=np.float64)
        customers = people.customers()
        return customers.as_tracks(stamp_ns, self.selector.choose(customers, stamp_ns, robot_xy))

    def _nobody(self) -> People:
        return People.nobody(self._config.confirm_window, modes_of(self._config))


@cache
def _compiled_track() -> type[CompiledTrack] | None:
    try:
        from tracker.tracking.compiled.frame import CompiledTrack
    except ModuleNotFoundError as error:
        if error.name != "numba":
            raise
        return None
    return CompiledTrack
