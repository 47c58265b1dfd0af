"""One frame of everybody, in one call: `tracker.tracking.frame`, compiled."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tracker.config import Config
from tracker.containers import FloatArray, Measurements
from tracker.containers.arrays import FLAGS, constant
from tracker.tracking.admission import hand_bias, is_semidefinite
from tracker.tracking.compiled.kernel import track_frame
from tracker.tracking.compiled.settings import settings_of
from tracker.tracking.compiled.state import State, people_of, state_of
from tracker.tracking.motion import motion_over
from tracker.tracking.people import People
from tracker.tracking.view import View

_NOTHING = np.zeros(0)


class CompiledTrack:
    """`tracker.tracking.frame.track`; remembers the numbers of the configuration it met last."""

    def __init__(self) -> None:
        self._config: Config | None = None
        self._settings = _NOTHING

    def __call__(
        self,
        people: People,
        measurements: Measurements,
        next_id: int,
        dt_s: float,
        stamp_ns: int,
        config: Config,
        view: View | None,
        scan_view: View | None,
    ) -> tuple[People, int]:
        """Everybody after one instant, and the identity of the next customer."""
        if config is not self._config:
            self._config, self._settings = config, settings_of(config)
        motion = motion_over(dt_s, config)
        *state, mean, covariance, next_id = track_frame(
            *state_of(people),
            *_claims(measurements),
            *(motion.transition, motion.noise, motion.switching),
            *(_numbers(view), _numbers(scan_view), scan_view is not None),
            *(next_id, dt_s, stamp_ns, hand_bias(dt_s, config), self._settings),
        )
        return people_of(State(*state), mean, covariance), next_id


def _claims(measurements: Measurements) -> Iterator[np.ndarray]:
    doubt = measurements.sensor_pose_covariance
    may_enter = constant(True, doubt.shape[:1], FLAGS)
    if doubt is not constant(0.0, doubt.shape) and np.count_nonzero(doubt):
        may_enter = is_semidefinite(doubt)
    return map(
        np.ascontiguousarray,
        (
            *(measurements.values, measurements.covariance, measurements.kind),
            *(measurements.sensor_pose, measurements.raised, measurements.person),
            *(measurements.hand, doubt, may_enter),
        ),
    )


def _numbers(view: View | None) -> FloatArray:
    if view is None:
        return _NOTHING
    numbers = np.empty(5)
    numbers[:3], numbers[3], numbers[4] = (
        view.sensor_pose, view.horizontal_fov_rad, view.range_max_m
    )  # fmt: skip
    return numbers
