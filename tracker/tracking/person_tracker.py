"""The whole tracker in one call: measurements of one instant in, tracks out."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike

from tracker.compiling.machine import Machine
from tracker.config import Config
from tracker.containers import FloatArray, Measurements, Tracks, View, WaitingList, check_stamp
from tracker.containers.arrays import sealed
from tracker.errors import ShapeError
from tracker.service.call_keeper import CallKeeper
from tracker.tracking.doors import Associator, MotionModel, association_by, prediction_by
from tracker.tracking.frame import interpreted, make_frame, track_frame
from tracker.tracking.instant import Instant
from tracker.tracking.life_cycle.renewal import Frame
from tracker.tracking.machine_frame import machine
from tracker.tracking.people import DETECTED, ID, MISSED, RAISED, room_for, with_room
from tracker.tracking.prediction.modes import merge_modes
from tracker.tracking.prediction.motion import modes_of
from tracker.tracking.reconfiguration import under
from tracker.tracking.result import customers_of, tracks_of
from tracker.tracking.sensing.claims import Claims, claims_of
from tracker.tracking.sensing.multilateration import with_positions
from tracker.tracking.sensing.view import view_numbers
from tracker.tracking.settings import record_of, settings_of
from tracker.tracking.trace import NO_TRACE, Trace, Watch, Watched

NO_LIKENESS = sealed(np.zeros((0, 0)))


class PersonTracker:
    """Kalman-filtered customers, from raised hands and the people in the scan.

    Raised hands create customers and count for their streaks. Other measurements only keep known
    people alive and improve their positions. Bystanders, who are only in the scan, are tracked as
    well, so that their measurements are not assigned to customers. Identities count from 1 and are
    never reused by one tracker.

    Args:
        config: The groups tracking, selection and service.
        motion: A motion model of your own, (means, covariances, seconds) -> (means, covariances),
            of shapes (N, 4) and (N, 4, 4), instead of `motion` in the configuration.
        associate: An association of your own: log-odds of every track and measurement, shape
            (N, M), -inf outside the gate -> probabilities of the same shape, instead of
            `association` in the configuration.
        watch: Called with every frame and what happened inside; see `tracking.trace`.
        compiled: Use the compiled frame as soon as it is there; the results are equal except for
            rounding. With a function of your own, frames run as Python.
    """

    def __init__(
        self,
        config: Config | None = None,
        *,
        motion: MotionModel | None = None,
        associate: Associator | None = None,
        watch: Watch | None = None,
        compiled: bool = True,
    ) -> None:
        self._motion = motion
        self._frame = interpreted(track_frame)
        self._machine: Machine | None = None
        if motion is not None or associate is not None:
            frame = make_frame(prediction_by(motion), association_by(associate))
            self._frame = interpreted(frame)
        elif compiled:
            self._machine = machine()
            if self._machine is not None:
                self._machine.start()
        self._watch = watch
        self._next_id, self._next_bystander = 1, -1
        self._stamp_ns: int | None = None
        self.calls = CallKeeper(config or Config())
        self._set_config(config or Config())
        self._now = self._nobody()

    @property
    def config(self) -> Config:
        """The parameters in force; setting them keeps the tracks."""
        return self._config

    @config.setter
    def config(self, config: Config) -> None:
        self._set_config(config)
        self._now = under(self._now, self._config)

    @property
    def has_tracks(self) -> bool:
        """Whether anybody is tracked now."""
        return bool((self._now.people.counts[ID] > 0).any())

    @property
    def people(self) -> Tracks:
        """Everybody at the last step, bystanders too, whose identities are below 0."""
        return tracks_of(self._now, self._stamp_ns or 0, None)

    @property
    def positions_m(self) -> FloatArray:
        """Shape (N, 2): where everybody was at the last step, in the fixed frame."""
        return self._now.mean[0, :, :2]

    def reset(self) -> None:
        """Forget everybody, and who has called; identities go on counting."""
        self._now = self._nobody()
        self._stamp_ns = None
        self.calls.reset()

    def restore(self, kept: WaitingList) -> None:
        """Continue with an earlier waiting list; its numbers are not given to other people."""
        self._next_id = max([self._next_id, *(caller.id + 1 for caller in kept.callers)])
        self.calls.restore(kept)

    def lower_hands(self) -> None:
        """Let every hand count as down until it is seen up again; identities stay."""
        people = with_room(self._now.people, 0)  # tracks that were handed out stay as they were
        people.counts[[DETECTED, MISSED]] = 0
        people.flags[RAISED] = False
        self._now = self._now._replace(people=people)
        self.calls.lower_hands()

    def doubt(self, moved: FloatArray, over_s: float) -> None:
        """Widen everybody's covariance by a motion of the robot that was not measured.

        Args:
            moved: Shape (3,): x_m, y_m, yaw_rad of a rigid motion about the origin, such as the
                camera's while it was supposed to stand still.
            over_s: In which time.
        """
        people = with_room(self._now.people, 0)
        cos, sin = np.cos(moved[2]), np.sin(moved[2])
        here_m = people.mean[..., :2]
        off_m = here_m @ np.array([[cos, sin], [-sin, cos]]) + moved[:2] - here_m
        off = np.concatenate([off_m, off_m / max(over_s, 1e-3)], axis=-1)
        people.covariance[:] += off[..., :, None] * off[..., None, :]
        mean, covariance = self._now.mean.copy(), self._now.covariance.copy()
        merge_modes(*people[:3], mean[0], covariance[0])
        self._now = self._now._replace(people=people, mean=mean, covariance=covariance)

    def step(
        self,
        stamp_ns: int,
        measurements: Measurements,
        robot_xy_m: ArrayLike = (0.0, 0.0),
        *,
        view: View | None = None,
        scan_view: View | None = None,
        camera_looked: bool = True,
        likeness: ArrayLike | None = None,
    ) -> Tracks:
        """Take in everything that was measured at one instant.

        A stamp before the last one means that the clock has jumped: everybody is forgotten first.
        Each sensor's measurements count one after the other: nobody has two of one sensor, but
        for those that name the same `person`.

        Args:
            stamp_ns: Sensor time of the measurements.
            measurements: In the fixed frame; may be empty.
            robot_xy_m: Shape (2,): where the robot is, for `selection: nearest`.
            view: Where the camera could see hands; None means everywhere.
            scan_view: Where the scan could show people; None where there is no scan.
            camera_looked: False for a step of another sensor between two images: nobody's hand
                was missed then.
            likeness: Shape (N, M): how much likelier it is that measurement j is of customer i of
                the last step's `Tracks` (or of row i of `people`, everybody) than of anybody else,
                as the logarithm of a ratio; NaN or 0 where nothing is known.

        Returns:
            Every customer, tentative ones included (`confirmed` tells), with the selected one.

        Raises:
            ClockError: The stamp is negative, or beyond 64 bits.
            ShapeError: `likeness` has another shape, or is infinite.
        """
        check_stamp(stamp_ns)
        stamp_ns = int(stamp_ns)  # NumPy has others, for which the frame was not compiled
        told = self._likeness(likeness, len(measurements))
        if self._stamp_ns is not None and stamp_ns < self._stamp_ns:
            self.reset()
            told = NO_LIKENESS  # of those who are forgotten
        dt_s = 0.0 if self._stamp_ns is None else (stamp_ns - self._stamp_ns) / 1e9
        # Beyond the longest memory everybody is gone anyway; a day's gap must not overflow.
        dt_s = min(dt_s, 10.0 * max(self._config.delete_after_s, self._config.forget_after_s))
        if likeness is None:  # whose columns are the measurements as they came
            measurements = with_positions(measurements)
        claims = claims_of(measurements)
        instant = Instant(
            stamp_ns,
            dt_s,
            self._next_id,
            self._next_bystander,
            view_numbers(view),
            view_numbers(scan_view),
            scan_view is not None,
            bool(camera_looked),
        )
        self._run(claims, instant, told)
        self._stamp_ns = stamp_ns
        tracks = tracks_of(self._now, stamp_ns, customers_of(self._now))
        seen = self.people if self.calls.wants_bystanders else tracks
        calls = self.calls.step(seen, np.asarray(robot_xy_m, dtype=np.float64), scan_view)
        tracks.__dict__["selected_id"] = calls.selected_track_id
        return tracks

    def _run(self, claims: Claims, instant: Instant, likeness: FloatArray) -> None:
        people, watch = self._now.people, self._watch
        trace = NO_TRACE if watch is None else Trace.room(len(claims.kind), *people.weight.shape)
        frame, settings = self._frame, cast(Any, self._settings)
        if self._machine is not None and self._machine.code is not None:
            frame, settings = self._machine.code, self._record
        self._now = frame(people, claims, instant, likeness, settings, trace)
        self._next_id, self._next_bystander = self._now.next_id, self._now.next_bystander
        if watch is not None:
            watch(Watched(instant.stamp_ns, people, claims, trace, self._config))

    def _likeness(self, likeness: ArrayLike | None, measured: int) -> FloatArray:
        """For the loops: a row for everybody, bystanders too."""
        if likeness is None:
            return NO_LIKENESS
        customers = customers_of(self._now)
        rows = slice(None) if customers is None else customers
        everybody = np.zeros((len(self.positions_m), measured))
        if np.shape(likeness) == everybody.shape:  # of bystanders as well
            rows = slice(None)
        shape = everybody[rows].shape
        told = np.nan_to_num(
            np.asarray(likeness, dtype=np.float64), nan=0.0, posinf=np.inf, neginf=-np.inf
        )
        if told.shape != shape or not np.isfinite(told).all():
            raise ShapeError(
                f"`likeness` has shape {told.shape}, or is infinite; expected finite numbers of "
                f"shape {shape}: the customers of the last step, and the measurements."
            )
        everybody[rows] = told
        return sealed(everybody)

    def _set_config(self, config: Config) -> None:
        if self._motion is not None:  # which has one mode
            config = config.model_copy(update={"motion": "cv"})
        self._config = self.calls.config = config
        self._settings = settings_of(config)
        self._record = record_of(self._settings)

    def _nobody(self) -> Frame:
        people = room_for(modes_of(self._config), 0, self._config.confirm_window)
        return Frame(
            people, np.zeros((1, 0, 4)), np.zeros((1, 0, 4, 4)),
            self._next_id, self._next_bystander, 0,
        )  # fmt: skip
