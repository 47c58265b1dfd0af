"""How good was a tracker over one trial? All figures of its frames, taken at once."""

from __future__ import annotations

import numpy as np
from scipy.stats import chi2

from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, Tracks, Truth
from tracker.evaluation.metrics.consistency import normalized_squared
from tracker.evaluation.metrics.frames import TrackFrames, TruthFrames
from tracker.evaluation.metrics.gospa import gospa_frames
from tracker.evaluation.metrics.identity import identity_switches, track_purity
from tracker.evaluation.metrics.matching import distances, match_faithfully
from tracker.evaluation.metrics.ospa import ospa_of
from tracker.evaluation.metrics.raised_hands.raise_reports import Allowed
from tracker.evaluation.metrics.raised_hands.raises import count_raises
from tracker.evaluation.metrics.raised_hands.trial_episodes import judge_trial

CUTOFF_M = 1.0
#: Squared normalized errors in the plane that a right covariance keeps below, 95 times of 100.
_COVERED = float(chi2.ppf(0.95, 2))


class TrialScores:
    """Gathers one trial frame by frame, of whichever tracker; for the figures see `score_trial`.

    Args:
        config: The streaks, for what counts as a missed raise.
    """

    def __init__(self, config: Config) -> None:
        self._config = config
        self._truths: list[Truth] = []
        self._tracks: list[Tracks] = []

    def add(self, truth: Truth, tracks: Tracks) -> None:
        """Take in one frame.

        Args:
            truth: Everybody who is there.
            tracks: Everybody whom the tracker knows; tentative ones do not count.
        """
        self._truths.append(truth)
        self._tracks.append(tracks)

    def row(self) -> dict[str, float]:
        """The trial's figures."""
        truth, tracks = TruthFrames.of(self._truths), TrackFrames.of(self._tracks)
        return score_trial(truth, tracks, self._config)


def score_trial(truth: TruthFrames, tracks: TrackFrames, config: Config) -> dict[str, float]:
    """One trial's figures; means over its frames, NaN where there was nothing to measure.

    Only people whose hand has been up count: before, nobody could know them. Identities and
    `rmse_m` keep to the pairs of the CLEAR MOT metrics, in which a track goes on standing for its
    person while it is nearer than the cutoff. `nees_position` and `covered_share` ask whether the
    covariance is right, not whether the identity is: they take each frame's best pairs, GOSPA's.

    Args:
        truth: Everybody who is there.
        tracks: Whom the tracker knows.
        config: The streaks, for what counts as a missed raise.

    Returns:
        Figures by name; `study.PeopleStudy` puts them into words.
    """
    is_there = truth.is_there
    has_called = np.logical_or.accumulate(truth.hand_up & truth.in_view & is_there, axis=0)
    is_known = is_there & has_called
    known, tracked = is_known.sum(axis=1), (tracks.id > 0).sum(axis=1)
    apart_m = distances(tracks.xy_m, truth.xy_m)
    from_known_m = np.where(is_known[:, None], apart_m, np.inf)
    sets = gospa_frames(from_known_m, tracked, known, CUTOFF_M)
    alone = CUTOFF_M**2 / 2.0
    return {
        "gospa_m": float(sets.distance_m.mean()),
        "gospa_localisation": float(sets.localisation.mean()),
        "gospa_missed": float(sets.missed.mean()),
        "gospa_false": float(sets.false.mean()),
        "ospa_m": float(ospa_of(sets, np.maximum(known, tracked)).mean()),
        "missed_share": float(sets.missed.sum() / alone / known.sum()) if known.any() else np.nan,
        "false_tracks": float(sets.false.mean() / alone),
        **_identity_figures(truth, tracks, from_known_m),
        **_consistency_figures(truth, tracks, sets.pairs),
        **_raise_figures(truth, tracks, apart_m, config),
    }


def _identity_figures(
    truth: TruthFrames, tracks: TrackFrames, apart_m: FloatArray
) -> dict[str, float]:
    near = np.where(apart_m < CUTOFF_M, CUTOFF_M**2 - apart_m**2, 0.0)
    pairs = match_faithfully(tracks.id, near)
    frame, row, column = np.nonzero(pairs)
    person, track = truth.id[column], tracks.id[frame, row]
    stamps_ns = truth.stamps_ns
    frame_s = (stamps_ns[-1] - stamps_ns[0]) / 1e9 / max(len(stamps_ns) - 1, 1)
    minutes = float(frame_s * len(stamps_ns) / 60.0)
    switches = identity_switches(person, track)
    return {
        "identity_switches_per_min": switches / minutes if minutes else np.nan,
        "track_purity": track_purity(person, track),
        "rmse_m": float(np.sqrt(_mean(apart_m[pairs] ** 2))),
    }


def _consistency_figures(
    truth: TruthFrames, tracks: TrackFrames, pairs: BoolArray
) -> dict[str, float]:
    frame, row, column = np.nonzero(pairs)
    error = truth.xy_m[frame, column] - tracks.xy_m[frame, row]
    nees = normalized_squared(error, tracks.covariance_m2[frame, row])
    return {"nees_position": _mean(nees), "covered_share": _mean(nees <= _COVERED)}


def _raise_figures(
    truth: TruthFrames, tracks: TrackFrames, apart_m: FloatArray, config: Config
) -> dict[str, float]:
    allowed = Allowed(config.raise_streak, config.lower_streak)
    raises = count_raises(judge_trial(truth, tracks, apart_m, CUTOFF_M, allowed))
    return {
        "time_to_raise_s": float(np.mean(raises.delays_s)) if raises.delays_s else np.nan,
        "hands": float(raises.hands),
        "missed_raises": float(raises.missed),
        "false_raises": float(raises.false),
        "raised_again": float(raises.again),
        "same_identity": float(raises.same),
        "wrong_identity": float(raises.wrong),
    }


def _mean(values: FloatArray | BoolArray) -> float:
    return float(values.mean()) if len(values) else float("nan")
