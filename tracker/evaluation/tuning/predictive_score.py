"""How well was each measurement predicted? A score for recordings without truth.

Before a measurement counts, the tracker expects people where it believes them, and newcomers and
false measurements anywhere. So it predicts where the next measurement is, one step ahead:

    f(z) = ( lambda + sum_t r_t Pd_t p_t(z) ) / ( lambda A + sum_t r_t Pd_t )    per square meter,

with lambda the density of newcomers, A the area in view, and of each person the existence r, the
chance to be detected Pd and the predicted density p. The mean of log f is a proper score: nothing
scores better on average than what is true. A tracker whose gates reject everything predicts
nothing and gets log(1 / A); one that believes in ghosts, or in itself too much, does worse.

Source: log score: Gneiting and Raftery, "Strictly Proper Scoring Rules, Prediction, and
    Estimation", JASA 102, 2007. Intensity: Mahler, "Statistical Multisource-Multitarget
    Information Fusion", 2007, on Poisson approximations of multi-target predictions.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tracker.config import Config
from tracker.containers import FloatArray, IntArray, View
from tracker.evaluation.metrics.innovations import log_densities
from tracker.evaluation.metrics.rounds import Round, rounds_of
from tracker.evaluation.recordings.tracker_steps import Step, run_steps
from tracker.tracking.trace import Watched


class PredictiveScore:
    """A `Watch` that scores every measurement, also those that nobody gets.

    Args:
        camera_area_m2: In which raised hands can be measured.
        scan_area_m2: In which everything else can.
    """

    def __init__(self, camera_area_m2: float, scan_area_m2: float) -> None:
        self._camera_area_m2, self._scan_area_m2 = camera_area_m2, scan_area_m2
        self._stamps: list[IntArray] = [np.zeros(0, dtype=np.int64)]
        self._scores: list[FloatArray] = [np.zeros(0)]

    def __call__(self, watched: Watched) -> None:
        """Score a frame's measurements."""
        for round_ in rounds_of(watched):
            self._score(round_)

    def _score(self, round_: Round) -> None:
        count = len(round_.rows)
        expected = round_.existence * round_.chance
        share = np.exp(log_densities(round_) - round_.log_newcomer) * expected[round_.track]
        place = np.searchsorted(round_.rows, round_.claim)
        predicted = np.bincount(place, share, count)  # in units of the newcomers' density
        is_hand = bool(round_.claims.raised[round_.rows[0]])  # of all or of none in a round
        area_m2 = self._camera_area_m2 if is_hand else self._scan_area_m2
        config = round_.config
        density = config.newcomer_density if is_hand else config.bystander_density
        total = density * area_m2 + expected.sum()
        self._scores.append(np.log(density) + np.log1p(predicted) - np.log(total))
        self._stamps.append(np.full(count, round_.stamp_ns, dtype=np.int64))

    @property
    def stamps_ns(self) -> IntArray:
        """Shape (K,): of every measurement so far."""
        return np.concatenate(self._stamps)

    @property
    def log_densities(self) -> FloatArray:
        """Shape (K,): log f of every measurement, per square meter."""
        return np.concatenate(self._scores)


def score_steps(steps: Sequence[Step], config: Config) -> PredictiveScore:
    """Run a recording's measurements through a tracker, and score each of them.

    Args:
        steps: One or more, from `tracker_steps.recorded_steps`.
        config: The tracker's parameters.
    """
    camera = max(_area_m2(step.view, config) for step in steps)
    scans = [_area_m2(step.scan_view, config) for step in steps if step.scan_view is not None]
    score = PredictiveScore(camera, max(scans, default=camera))
    for _ in run_steps(steps, config, score):
        pass
    return score


def _area_m2(view: View | None, config: Config) -> float:
    """The sector that a sensor sees; the full circle where nothing is known."""
    if view is None:
        return np.pi * config.person_range_max_m**2
    range_m = min(view.range_max_m, config.person_range_max_m)
    return 0.5 * min(view.horizontal_fov_rad, 2.0 * np.pi) * range_m**2
