import numpy as np
import pytest

from tracker import CameraImage, Config, Hands, Scan
from tracker.errors import RecordingError
from tracker.evaluation.tracker_steps import recorded_steps, run_steps
from tracker.geometry import RigidTransform
from tracker.recording import RecordingWriter
from tracker.replay import replay
from tracker.transforms import StampedTransform

START_NS = 1_700_000_000_000_000_000


class HandAhead:
    """A detector that sees one raised hand in the middle of each image."""

    def find(self, image):
        landmarks = np.full((1, 21, 2), 100.0)
        landmarks[:, :, 0] = image.width / 2
        landmarks[:, 12, 1] -= 60.0
        landmarks[:, 9, 1] -= 30.0
        one = np.ones(1)
        return Hands(landmarks, one, one, one.astype(bool), one)

    def reset(self):
        pass

    def configure(self, config):
        pass


@pytest.fixture
def recording(tmp_path):
    """Somebody 1.5 m ahead for two seconds; stamps jump back once, and transforms come late."""
    angles = np.radians(np.arange(720) / 2 - 180)
    ranges = np.where(np.abs(1.5 * np.tan(np.clip(angles, -1, 1))) < 0.2, 1.5, 5.0)
    path = tmp_path / "in.mcap"
    with RecordingWriter(path) as writer:
        for number in range(20):
            log_ns = START_NS + number * 100_000_000
            stamp_ns = log_ns - (5_000_000_000 if number == 12 else 0)
            if number == 4:
                for frame in ("camera_link", "laser"):
                    fixed = StampedTransform(0, "map", frame, RigidTransform(), is_static=True)
                    writer.write("/tf_static", log_ns, [fixed])
            scan = Scan(stamp_ns, "laser", -np.pi, np.radians(0.5), 0.05, 12.0, ranges)
            writer.write("/scan", log_ns, scan)
            picture = np.full((480, 640, 3), number, np.uint8)
            writer.write("/image_raw", log_ns, CameraImage(stamp_ns, "camera_link", picture))
    return path


def test_the_steps_give_the_very_tracks_of_a_replay(recording, tmp_path):
    steps = recorded_steps(recording, detector=HandAhead())
    tracks = list(run_steps(steps, Config()))
    replay(recording, tmp_path / "out", detector=HandAhead())
    rows = np.genfromtxt(tmp_path / "out/tracks.csv", delimiter=",", names=True)
    found = [
        (item.id[row], *item.mean[row, :2]) for item in tracks for row in range(len(item))
        if item.confirmed[row]
    ]  # fmt: skip
    assert len(found) > 10
    expected = np.stack([rows["track_id"], rows["x_m"], rows["y_m"]], axis=-1)
    np.testing.assert_allclose(found, expected, atol=1e-3)


def test_other_parameters_give_other_tracks_of_the_same_measurements(recording):
    steps = recorded_steps(recording, detector=HandAhead())
    usual = list(run_steps(steps, Config()))
    slow = list(run_steps(steps, Config(confirm_detections=5, confirm_window=5)))
    assert sum(item.confirmed.sum() for item in slow) < sum(t.confirmed.sum() for t in usual)


def test_a_recording_without_images_is_refused(tmp_path):
    with RecordingWriter(tmp_path / "in.mcap") as writer:
        writer.write("/scan", 1, Scan(1, "laser", 0.0, 0.1, 0.05, 12.0, np.ones(5)))
    with pytest.raises(RecordingError, match="image"):
        recorded_steps(tmp_path / "in.mcap", detector=HandAhead())
