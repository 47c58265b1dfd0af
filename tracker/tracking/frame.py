"""One frame of everybody: from people and measurements to people."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from tracker.compiling.loops import maker
from tracker.containers import FloatArray
from tracker.tracking.association.admission import plan_rounds
from tracker.tracking.association.association import associate
from tracker.tracking.association.found import nothing_found, take
from tracker.tracking.association.gating import find_pairs
from tracker.tracking.instant import Instant
from tracker.tracking.life_cycle.life_cycle import believe, fade
from tracker.tracking.life_cycle.renewal import Frame, renew
from tracker.tracking.people import MISSED, People, with_room
from tracker.tracking.prediction.modes import merge_modes
from tracker.tracking.prediction.motion import predict
from tracker.tracking.sensing.claims import Claims
from tracker.tracking.sensing.view import visibility
from tracker.tracking.settings import Settings
from tracker.tracking.trace import Trace, note_round
from tracker.tracking.update.bias import consider_bias
from tracker.tracking.update.correction import correct_people

#: Of a raised hand, the chance that one counts whose owner had it down in the last frame (guess).
RAISES_AGAIN = 0.5
#: Nobody is ever certain to be detected, or certain not to be.
DETECTION_MIN = 0.02


def make_frame(predict: Callable[..., Any], associate: Callable[..., Any]) -> Callable[..., Frame]:
    """The function of one frame, with these two steps.

    Args:
        predict: As `motion.predict`.
        associate: As `association.associate`.
    """

    def track_frame(
        people: People,
        claims: Claims,
        instant: Instant,
        likeness: FloatArray,
        settings: Settings,
        trace: Trace,
    ) -> Frame:
        """Everybody after one instant.

        Args:
            people: N people, after the last frame.
            claims: M claims.
            instant: When it is, and what could be seen.
            likeness: Shape (N, M): added to the log-odds of pairs; empty for nothing.
            settings: Of the tracker.
            trace: Room for what a watcher wants to know; empty where nobody watches.
        """
        tracks, now = people.weight.shape[1], with_room(people, 0)
        mean, covariance = np.empty((1, tracks, 4)), np.empty((1, tracks, 4, 4))
        predict(people, instant.dt_s, settings, now)
        merge_modes(now.weight, now.mean, now.covariance, mean[0], covariance[0])
        in_camera = visibility(mean, instant.camera_view)
        in_view = _in_view(in_camera, mean, instant)
        fade(now, covariance, instant.dt_s, in_view, settings.delete_after_s)
        rounds = plan_rounds(now, mean, claims, settings)
        found = nothing_found(tracks, len(claims.kind), rounds.rows)
        for number in range(len(rounds.begins) - 1):
            is_raised = number < rounds.raised
            rows = rounds.rows[rounds.begins[number] : rounds.begins[number + 1]]
            density = settings.newcomer_density if is_raised else settings.bystander_density
            if number > 0:
                merge_modes(now.weight, now.mean, now.covariance, mean[0], covariance[0])
            chance = _chance(now, in_camera if is_raised else in_view, is_raised, settings)
            pairs = find_pairs(
                now, mean, covariance, claims, rows, chance, likeness, density, settings
            )
            chosen, probability = associate(pairs, tracks, len(claims.kind), settings)
            note_round(trace, number, rows, now, chance, pairs, chosen)
            correct_people(now, claims, pairs, probability, settings.outlier_dof)
            believe(now, chosen, pairs, chance)
            consider_bias(now, covariance, chosen, pairs, claims)
            take(found, chosen, probability, pairs, claims)
        return renew(now, claims, found, instant, settings)

    return track_frame


@maker
def _in_view(in_camera: FloatArray, mean: FloatArray, instant: Instant) -> FloatArray:
    """Shape (N,): chance of being seen by anything."""
    if not instant.has_scan:
        return in_camera
    in_scan = visibility(mean, instant.scan_view)
    for person in range(len(in_scan)):
        in_scan[person] = max(in_scan[person], in_camera[person])
    return in_scan


@maker
def _chance(
    people: People, visible: FloatArray, is_raised: bool, settings: Settings
) -> FloatArray:
    """Shape (N,): of being detected in one round."""
    chance = np.empty(len(visible))
    for person in range(len(visible)):
        again = RAISES_AGAIN if is_raised and people.counts[MISSED, person] > 0 else 1.0
        likely = visible[person] * again * settings.detection_probability
        chance[person] = max(likely, DETECTION_MIN)
    return chance


track_frame = make_frame(predict, associate)


def interpreted(frame: Callable[..., Frame]) -> Callable[..., Frame]:
    """A frame as Python: without warnings about infinities, which are intended here."""

    def run(*numbers: Any) -> Frame:
        with np.errstate(all="ignore"):
            return frame(*numbers)

    return run
