import numpy as np
import pytest

from tracker import Config
from tracker.containers import FrameResult, Hands, Measurements, Tracks, Truth
from tracker.evaluation.metrics.frames import TrackFrames, TruthFrames
from tracker.evaluation.metrics.raised_hands.episodes import EpisodeEvaluation
from tracker.evaluation.metrics.raised_hands.raises import count_raises
from tracker.evaluation.metrics.scores import TrialScores, score_trial

PERIOD_NS = 100_000_000
CONFIG = Config()


def truth_at(frame, xy, *, up=True):
    people = np.arange(len(xy))
    return Truth((1 + frame) * PERIOD_NS, people, xy, np.full(len(xy), up), np.full(len(xy), True))


def tracks_at(frame, ids, xy, variance=1.0, raised=True):
    count = len(ids)
    return Tracks(
        stamp_ns=(1 + frame) * PERIOD_NS, id=ids, mean=np.hstack([xy, np.zeros((count, 2))]),
        covariance=np.tile(variance * np.eye(4), (count, 1, 1)), existence=np.ones(count),
        confirmed=np.ones(count), raised=np.broadcast_to(raised, count),
        raised_since_ns=np.zeros(count), age_s=np.zeros(count), unseen_s=np.zeros(count),
        hand=np.full(count, -1),
    )  # fmt: skip


def scored(frames):
    scores = TrialScores(CONFIG)
    for truth, tracks in frames:
        scores.add(truth, tracks)
    return scores.row()


def test_a_covariance_that_is_right_covers_95_of_100():
    rng = np.random.default_rng(4)
    xy = np.array([[2.0, 0.0], [4.0, 0.0], [6.0, 0.0]])
    row = scored(
        (truth_at(frame, xy), tracks_at(frame, [1, 2, 3], rng.normal(xy, 0.1), 0.01))
        for frame in range(2000)
    )
    assert row["covered_share"] == pytest.approx(0.95, abs=0.01)
    assert row["nees_position"] == pytest.approx(2.0, abs=0.1)


def test_the_ellipse_has_two_degrees_of_freedom():
    # 5.99 is the quantile: 2.44 standard deviations are inside, 2.46 are not.
    for off, covered in ((0.244, 1.0), (0.246, 0.0)):
        row = scored([(truth_at(0, [[2.0, 0.0]]), tracks_at(0, [1], [[2.0 + off, 0.0]], 0.01))])
        assert row["covered_share"] == covered


def test_consistency_takes_the_nearest_pairs_and_identities_the_faithful_ones():
    # The tracks of two neighbors change places, and stay there.
    here, there = np.array([[2.0, 0.0], [2.6, 0.0]]), np.array([[2.6, 0.0], [2.0, 0.0]])
    row = scored(
        (truth_at(frame, here), tracks_at(frame, [1, 2], here if frame < 5 else there, 0.01))
        for frame in range(10)
    )
    assert row["nees_position"] == 0.0
    assert row["covered_share"] == 1.0
    assert row["rmse_m"] == pytest.approx(0.6 / np.sqrt(2.0))
    assert row["identity_switches_per_min"] == 0.0


def test_a_pair_beyond_the_cutoff_counts_as_missed_and_not_as_inconsistent():
    row = scored([(truth_at(0, [[2.0, 0.0]]), tracks_at(0, [1], [[3.1, 0.0]], 0.01))])
    assert (row["missed_share"], row["false_tracks"]) == (1.0, 1.0)
    assert np.isnan(row["nees_position"])
    assert np.isnan(row["covered_share"])


def test_people_count_once_their_hand_has_been_up():
    row = scored(
        (truth_at(frame, [[2.0, 0.0]], up=frame >= 6), tracks_at(frame, [], np.zeros((0, 2))))
        for frame in range(10)
    )
    assert row["gospa_missed"] == pytest.approx(0.5 * 0.4)
    assert row["missed_share"] == 1.0


def test_a_trial_with_nobody_and_nothing_has_no_error():
    row = scored([(truth_at(0, np.zeros((0, 2))), tracks_at(0, [], np.zeros((0, 2))))])
    assert (row["gospa_m"], row["ospa_m"], row["hands"]) == (0.0, 0.0, 0.0)
    assert np.isnan(row["missed_share"])


def result_of(tracks):
    return FrameResult(
        stamp_ns=tracks.stamp_ns, hands=Hands.none(), measurements=Measurements.none(),
        tracks=tracks, hand_raised=False, customer_pose=None, approach_pose=None,
        sensor_pose=None, scan=None,
    )  # fmt: skip


def test_raises_are_those_that_the_evaluation_of_recordings_finds():
    rng = np.random.default_rng(6)
    for _ in range(20):
        people, tracks = rng.uniform(0.0, 3.0, (2, 4, 2))
        up, raised, in_view = rng.random((3, 4)) < 0.6
        evaluation, truths, told = EpisodeEvaluation(), [], []
        for frame in range(60):
            up, raised, in_view = (
                flags ^ (rng.random(4) < 0.06) for flags in (up, raised, in_view)
            )
            is_there = rng.random(4) < 0.98
            ids = np.flatnonzero(is_there)
            stamp_ns = (1 + frame) * PERIOD_NS
            truth = Truth(stamp_ns, ids, people[ids], up[ids], in_view[ids])
            seen = tracks_at(frame, np.arange(1, 5), tracks, raised=raised)
            people, tracks = (xy + rng.normal(0.0, 0.05, xy.shape) for xy in (people, tracks))
            truths.append(truth)
            told.append(seen)
            evaluation.add_truth(truth)
            evaluation.add_result(result_of(seen))
        row = score_trial(TruthFrames.of(truths), TrackFrames.of(told), CONFIG)
        expected = count_raises(evaluation.report())
        assert row["hands"] == expected.hands > 0
        assert row["missed_raises"] == expected.missed
        assert row["false_raises"] == expected.false
        assert row["same_identity"] == expected.same
        assert row["wrong_identity"] == expected.wrong
        if expected.delays_s:
            assert row["time_to_raise_s"] == pytest.approx(np.mean(expected.delays_s))
