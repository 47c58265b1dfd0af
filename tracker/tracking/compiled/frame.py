"""One frame of everybody known, in one call: `tracker.tracking.frame.observe`, compiled."""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import FloatArray, Measurements
from tracker.tracking import frame
from tracker.tracking.admission import hand_bias, is_semidefinite, with_hand_bias
from tracker.tracking.compiled.kernel import track_frame
from tracker.tracking.compiled.settings import settings_of
from tracker.tracking.frame import NO_MEASUREMENTS, Observed
from tracker.tracking.modes import Belief
from tracker.tracking.motion import motion_over
from tracker.tracking.people import People
from tracker.tracking.streaks import Streaks
from tracker.tracking.view import View

_EVERYWHERE = np.zeros(0)


def observe(
    people: People,
    measurements: Measurements,
    dt_s: float,
    stamp_ns: int,
    config: Config,
    view: View | None,
    scan_view: View | None,
) -> Observed:
    """As `tracker.tracking.frame.observe`."""
    wears = measurements.appearance is not None and config.appearance_weight > 0.0
    if wears or config.measurement_model == "converted":
        return frame.observe(people, measurements, dt_s, stamp_ns, config, view, scan_view)
    motion, streaks, belief = motion_over(dt_s, config), people.streaks, people.belief
    doubt = measurements.sensor_pose_covariance
    may_enter = is_semidefinite(doubt) if doubt.any() else np.ones(len(measurements), dtype=bool)
    given = map(
        np.ascontiguousarray,
        (
            *(belief.weight, belief.mean, belief.covariance, people.id, people.born_ns),
            *(measurements.values, measurements.covariance, measurements.model),
            *(measurements.sensor_pose, measurements.raised, measurements.person),
            *(measurements.hand, doubt, may_enter),
            *(motion.transition, motion.noise, motion.switching),
            *(_numbers(view), _numbers(scan_view)),
        ),
    )
    weight, mean = np.empty(belief.weight.shape), np.empty(belief.mean.shape)
    covariance = np.empty(belief.covariance.shape)
    existence, missing_s = people.existence.copy(), people.missing_s.copy()
    detected_ns = (people.raised_since_ns, people.seen_ns, people.called_ns)
    counts = np.array([streaks.detected, streaks.missed, people.detections, *detected_ns])
    flags = np.array([streaks.raised, people.confirmed])
    recent, hand = people.recent.copy(order="C"), np.empty(len(people), dtype=np.int64)
    fate, is_left = np.empty((3, len(people)), dtype=bool), np.empty(len(measurements), dtype=bool)
    may_be_twice = track_frame(
        *given, scan_view is not None, dt_s, stamp_ns, hand_bias(dt_s, config),
        settings_of(config), weight, mean, covariance, existence, missing_s, counts, flags, recent,
        hand, fate, is_left,
    )  # fmt: skip
    detected, missed, detections, raised_since_ns, seen_ns, called_ns = counts
    is_up, confirmed = flags
    raised = others = NO_MEASUREMENTS
    if is_left.any():
        raised = with_hand_bias(measurements[is_left & measurements.raised], dt_s, config)
        others = measurements[is_left & ~measurements.raised]
    return Observed(
        people=People(
            id=people.id,
            belief=Belief(weight, mean, covariance),
            existence=existence,
            confirmed=confirmed,
            recent=recent,
            detections=detections,
            streaks=Streaks(detected, missed, is_up),
            raised_since_ns=raised_since_ns,
            born_ns=people.born_ns,
            seen_ns=seen_ns,
            called_ns=called_ns,
            missing_s=missing_s,
            hand=hand,
            appearance=people.appearance,
        ),
        is_called=fate[0],
        is_seen=fate[1],
        stay=fate[2],
        may_be_twice=may_be_twice,
        raised=raised,
        others=others,
    )


def _numbers(view: View | None) -> FloatArray:
    if view is None:
        return _EVERYWHERE
    return np.array([*view.sensor_pose, view.horizontal_fov_rad, view.range_max_m], np.float64)
