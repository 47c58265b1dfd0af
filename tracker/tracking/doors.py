"""How does a function of the user replace a step of the tracker?"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from scipy.optimize import linear_sum_assignment

from tracker.containers import FloatArray, IntArray
from tracker.containers.measurement_check import are_semidefinite
from tracker.errors import ShapeError
from tracker.tracking.association.association import associate
from tracker.tracking.association.gating import Pairs
from tracker.tracking.people import People
from tracker.tracking.prediction.motion import predict
from tracker.tracking.settings import Settings

#: Means (N, 4) and covariances (N, 4, 4) of everybody, and seconds: the same, so much later.
MotionModel: TypeAlias = Callable[[FloatArray, FloatArray, float], tuple[FloatArray, FloatArray]]
#: Log-odds of every track and measurement, shape (N, M), -inf outside the gate: probabilities that
#: the measurement is the track's, of the same shape, whose rows and columns add up to 1 at most.
Associator: TypeAlias = Callable[[FloatArray], FloatArray]

Predict: TypeAlias = Callable[[People, float, Settings, People], None]
Associate: TypeAlias = Callable[[Pairs, int, int, Settings], tuple[IntArray, FloatArray]]

#: Sums of probabilities may be off by so much, as those that an iteration ends at are.
_ROUNDING = 1e-6


def prediction_by(motion: MotionModel | None) -> Predict:
    """The tracker's own prediction, or the user's; see `PersonTracker`."""
    if motion is None:
        return predict

    def predict_by(people: People, dt_s: float, _: Settings, predicted: People) -> None:
        mean, covariance = motion(people.mean[0].copy(), people.covariance[0].copy(), dt_s)
        predicted.mean[0] = _checked("means from `motion`", mean, people.mean[0].shape)
        predicted.covariance[0] = _checked(
            "covariances from `motion`", covariance, people.covariance[0].shape
        )

    return predict_by


def association_by(associator: Associator | None) -> Associate:
    """The tracker's own association, or the user's; see `PersonTracker`."""
    if associator is None:
        return associate

    def associate_by(
        pairs: Pairs, tracks: int, claims: int, settings: Settings
    ) -> tuple[IntArray, FloatArray]:
        log_odds = np.full((tracks, claims), -np.inf)
        log_odds[pairs.track, pairs.claim] = pairs.log_odds
        told = _checked("probabilities from `associate`", associator(log_odds), log_odds.shape)
        sums = *told.sum(axis=0), *told.sum(axis=1)
        if (told < 0.0).any() or max(sums, default=0.0) > 1.0 + _ROUNDING:
            raise ShapeError(
                "`associate` returned numbers that are not probabilities; those of each track "
                "and of each measurement must be 0 or more and add up to at most 1."
            )
        pair_of = np.full((tracks, claims), -1)
        pair_of[pairs.track, pairs.claim] = np.arange(len(pairs.track))
        row, column = linear_sum_assignment(np.where(pair_of >= 0, told, 0.0), maximize=True)
        is_taken = (told[row, column] > 0.0) & (pair_of[row, column] >= 0)
        chosen = np.full(tracks, -1)
        chosen[row[is_taken]] = pair_of[row, column][is_taken]
        return chosen, told[pairs.track, pairs.claim]

    return associate_by


def _checked(name: str, given: FloatArray, shape: tuple[int, ...]) -> FloatArray:
    """Numbers from the user's function; a `ShapeError` where they do not fit."""
    numbers = np.asarray(given, dtype=np.float64)
    is_fit = numbers.shape == shape and np.isfinite(numbers).all()
    if not is_fit or (numbers.ndim == 3 and not are_semidefinite(numbers).all()):
        raise ShapeError(
            f"The {name} have shape {numbers.shape}, or are not finite, or are not covariances; "
            "expected "
            f"finite numbers of shape {shape}, covariances symmetric and not negative."
        )
    return numbers
