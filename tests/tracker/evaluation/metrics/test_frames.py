import numpy as np

from tracker.containers import Tracks, Truth
from tracker.evaluation.metrics.frames import TrackFrames, TruthFrames

TRUTHS = [
    Truth(10, [4, 2], [[0.0, 1.0], [2.0, 3.0]], [True, False], [True, True]),
    Truth(20, [], np.zeros((0, 2)), [], []),
    Truth(30, [2, 7], [[4.0, 5.0], [6.0, 7.0]], [True, True], [False, True]),
]


def tracks_of(ids, confirmed):
    count = len(ids)
    return Tracks(
        stamp_ns=0, id=ids, mean=np.outer(ids, np.ones(4)).reshape(-1, 4),
        covariance=np.tile(np.eye(4), (count, 1, 1)), existence=np.ones(count),
        confirmed=confirmed, raised=np.array(ids) > 2, raised_since_ns=np.zeros(count),
        age_s=np.zeros(count), unseen_s=np.zeros(count), hand=np.full(count, -1),
    )  # fmt: skip


def test_a_person_has_a_column_in_all_frames():
    frames = TruthFrames.of(TRUTHS)
    np.testing.assert_array_equal(frames.id, [2, 4, 7])
    np.testing.assert_array_equal(
        frames.is_there, [[True, True, False], [False, False, False], [True, False, True]]
    )
    np.testing.assert_array_equal(frames.xy_m[2], [[4.0, 5.0], [np.nan, np.nan], [6.0, 7.0]])


def test_frames_give_back_the_truths():
    for frame, truth in zip(TruthFrames.of(TRUTHS), TRUTHS, strict=True):
        order = np.argsort(truth.id)
        assert frame.stamp_ns == truth.stamp_ns
        for name in ("id", "xy_m", "hand_up", "in_view"):
            np.testing.assert_array_equal(getattr(frame, name), getattr(truth, name)[order])


def test_confirmed_tracks_fill_each_frame_from_the_left():
    frames = TrackFrames.of(
        [tracks_of([1, 3], [False, True]), tracks_of([], []), tracks_of([1, 3], [True, True])]
    )
    np.testing.assert_array_equal(frames.id, [[3, 0], [0, 0], [1, 3]])
    np.testing.assert_array_equal(frames.raised, [[True, False], [False, False], [False, True]])
    np.testing.assert_array_equal(frames.xy_m[:, 0, 0], [3.0, np.nan, 1.0])
    np.testing.assert_array_equal(frames.covariance_m2[2], [np.eye(2)] * 2)
