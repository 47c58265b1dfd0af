"""Stone Soup's trackers, fed with our measurements: for comparison on the same frames."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime, timedelta, timezone

import numpy as np
from stonesoup.dataassociator.neighbour import GNNWith2DAssignment
from stonesoup.dataassociator.probability import JPDAwithEHM2
from stonesoup.deleter.time import UpdateTimeStepsDeleter
from stonesoup.hypothesiser.distance import DistanceHypothesiser
from stonesoup.hypothesiser.probability import PDAHypothesiser
from stonesoup.initiator.simple import MultiMeasurementInitiator
from stonesoup.measures import Mahalanobis
from stonesoup.models.measurement.nonlinear import CartesianToBearingRange
from stonesoup.models.transition.linear import (
    CombinedLinearGaussianTransitionModel,
    ConstantVelocity,
)
from stonesoup.predictor.kalman import ExtendedKalmanPredictor
from stonesoup.tracker.simple import MultiTargetMixtureTracker, MultiTargetTracker
from stonesoup.types.detection import Detection
from stonesoup.types.state import GaussianState
from stonesoup.updater.kalman import ExtendedKalmanUpdater

from tracker import Measurements, Tracks

START = datetime(2026, 1, 1, tzinfo=timezone.utc).replace(tzinfo=None)
ORDER = [0, 2, 1, 3]  # x, y, vx, vy from Stone Soup's x, vx, y, vy


class StoneSoup:
    """One tracker: extended Kalman filter on bearing and range, constant velocity.

    Args:
        noise_std: Of bearing and range.
        association: `jpda` (exact, EHM2) or `gnn` (two-dimensional assignment).
        detection_probability: Told to the tracker as it truly is.
        clutter_density: Per radian and meter, as it truly is.
        acceleration_density: Process noise, m^2/s^3.
        min_points: Measurements that confirm a track.
        delete_after: Frames without a measurement that end one.
    """

    def __init__(
        self,
        noise_std: tuple[float, float],
        association: str = "jpda",
        *,
        detection_probability: float = 0.95,
        clutter_density: float = 0.01,
        acceleration_density: float = 0.5,
        min_points: int = 3,
        delete_after: int = 10,
    ) -> None:
        model = CombinedLinearGaussianTransitionModel([ConstantVelocity(acceleration_density)] * 2)
        self.predictor = predictor = ExtendedKalmanPredictor(model)
        self.sensor = CartesianToBearingRange(4, (0, 2), np.diag(np.square(noise_std)))
        self.updater = updater = ExtendedKalmanUpdater(self.sensor)
        self.associator = nearest = GNNWith2DAssignment(
            DistanceHypothesiser(predictor, updater, Mahalanobis(), missed_distance=3.0)
        )
        deleter = UpdateTimeStepsDeleter(delete_after)
        prior = GaussianState([[0.0], [0.0], [0.0], [0.0]], np.diag([9.0, 0.25, 9.0, 0.25]))
        initiator = MultiMeasurementInitiator(
            prior, deleter, nearest, updater, self.sensor, min_points=min_points
        )
        self._frame: tuple[datetime, set[Detection]] = (START, set())
        if association == "jpda":
            hypothesiser = PDAHypothesiser(
                predictor, updater, clutter_density, detection_probability, prob_gate=0.99
            )
            tracker, associator = MultiTargetMixtureTracker, JPDAwithEHM2(hypothesiser)
        else:
            tracker, associator = MultiTargetTracker, nearest
        self._tracker = tracker(initiator, deleter, self._frames(), associator, updater)
        self._steps = iter(self._tracker)
        self._ids: dict[str, int] = {}

    def step(self, stamp_ns: int, measurements: Measurements) -> Tracks:
        """Take in one frame; only confirmed tracks come out."""
        now = START + timedelta(microseconds=stamp_ns // 1000)
        bearings_ranges = np.array(measurements.values)
        self._frame = (
            now,
            {Detection(row[:, None], now, self.sensor) for row in bearings_ranges},
        )
        _, found = next(self._steps)
        ids, means, covariances = [], [], []
        for track in found:
            ids.append(self._ids.setdefault(track.id, len(self._ids) + 1))
            means.append(np.asarray(track.state_vector, dtype=float)[ORDER, 0])
            covariances.append(np.asarray(track.covar, dtype=float)[np.ix_(ORDER, ORDER)])
        count = len(ids)
        yes, zeros = np.ones(count, dtype=bool), np.zeros(count)
        return Tracks(
            stamp_ns=stamp_ns,
            id=np.array(ids, dtype=np.int64),
            mean=np.reshape(means, (count, 4)),
            covariance=np.reshape(covariances, (count, 4, 4)),
            existence=zeros + 1.0,
            confirmed=yes,
            raised=yes,
            raised_since_ns=np.full(count, stamp_ns),
            age_s=zeros,
            unseen_s=zeros,
            hand=np.full(count, -1),
        )

    def _frames(self) -> Iterator[tuple[datetime, set[Detection]]]:
        while True:
            yield self._frame
