import numpy as np
import pytest

from tracker import Config, Scan
from tracker.errors import RecordingError
from tracker.evaluation.recordings.tracker_steps import recorded_steps, run_steps
from tracker.recording import RecordingWriter
from tracker.replay import replay


@pytest.fixture
def recording(tmp_path, write_bag):
    """Somebody ahead for two seconds; stamps jump back once, and transforms come late."""
    return write_bag(tmp_path / "in.mcap", links_at=4, jump=12)


def test_the_steps_give_the_very_tracks_of_a_replay(recording, tmp_path, hand_ahead):
    steps = recorded_steps(recording, detector=hand_ahead)
    tracks = list(run_steps(steps, Config()))
    replay(recording, tmp_path / "out", detector=hand_ahead)
    rows = np.genfromtxt(tmp_path / "out/tracks.csv", delimiter=",", names=True)
    found = [
        (item.id[row], *item.mean[row, :2]) for item in tracks for row in range(len(item))
        if item.confirmed[row]
    ]  # fmt: skip
    assert len(found) > 10
    expected = np.stack([rows["track_id"], rows["x_m"], rows["y_m"]], axis=-1)
    np.testing.assert_allclose(found, expected, atol=1e-3)


def test_other_parameters_give_other_tracks_of_the_same_measurements(recording, hand_ahead):
    steps = recorded_steps(recording, detector=hand_ahead)
    usual = list(run_steps(steps, Config()))
    slow = list(run_steps(steps, Config(confirm_detections=5, confirm_window=5)))
    assert sum(item.confirmed.sum() for item in slow) < sum(t.confirmed.sum() for t in usual)


def test_a_recording_without_images_is_refused(tmp_path, hand_ahead):
    with RecordingWriter(tmp_path / "in.mcap") as writer:
        writer.write("/scan", 1, Scan(1, "laser", 0.0, 0.1, 0.05, 12.0, np.ones(5)))
    with pytest.raises(RecordingError, match="image"):
        recorded_steps(tmp_path / "in.mcap", detector=hand_ahead)
