import hashlib
from itertools import pairwise

import numpy as np
import pytest

from tracker.camera import CameraModel
from tracker.containers import CameraImage, Scan, Truth
from tracker.errors import SceneError
from tracker.recording import open_recording
from tracker.simulation import scene_from_mapping, simulate, topic_of, write_simulation
from tracker.simulation.motion import people_at
from tracker.transforms import StampedTransform, TransformBuffer


@pytest.fixture
def brief(room):
    """The small room for half a second."""
    return scene_from_mapping({**room, "duration_s": 0.5})


def fingerprint(events):
    digest = hashlib.sha256()
    for log_ns, event in events:
        digest.update(str(log_ns).encode())
        match event:
            case CameraImage():
                digest.update(event.bgr.tobytes())
            case Scan():
                digest.update(event.ranges_m.tobytes())
            case _:
                digest.update(topic_of(event).encode())
    return digest.hexdigest()


def test_the_same_seed_gives_the_same_bytes_and_another_seed_other_noise(brief):
    assert fingerprint(simulate(brief, 3)) == fingerprint(simulate(brief, 3))
    assert fingerprint(simulate(brief, 3)) != fingerprint(simulate(brief, 4))


def test_the_noise_of_one_sensor_does_not_depend_on_the_other(room):
    room["duration_s"] = 0.3
    scans = []
    for rate_hz in (30.0, 5.0):
        room["camera"]["rate_hz"] = rate_hz
        events = simulate(scene_from_mapping(room), 1)
        scans.append([event.ranges_m for _, event in events if isinstance(event, Scan)])
    np.testing.assert_array_equal(scans[0], scans[1])


def test_events_come_in_the_order_of_recording_at_their_rates(scene):
    events = list(simulate(scene, 1))
    times = [log_ns for log_ns, _ in events]
    assert all(before <= after for before, after in pairwise(times))
    topics = [topic_of(event) for _, event in events]
    counts = {topic: topics.count(topic) for topic in set(topics)}
    assert counts == {
        "/image_raw": 60,
        "/camera_info": 60,
        "/truth/people": 60,
        "/scan": 20,
        "/map": 1,
        "/tf": 102,
        "/tf_static": 3,
    }
    assert topics[:3] == ["/tf_static"] * 3
    images = [event for _, event in events if isinstance(event, CameraImage)]
    assert images[0].stamp_ns == 1_700_000_000_000_000_000
    assert images[1].stamp_ns - images[0].stamp_ns == 33_333_333
    assert images[0].bgr.shape == (120, 160, 3)
    model = next(event for _, event in events if isinstance(event, CameraModel))
    assert (model.fx, model.fy, model.cx, model.cy) == (115.0, 115.0, 80.0, 60.0)


@pytest.mark.parametrize("frame", ["camera_link", "camera_optical_frame"])
def test_transforms_place_the_sensors_where_the_truth_says(room, frame):
    room["camera"]["frame"] = frame
    room["laser"].update(noise_m=0.0, dropout=0.0)
    room["tables"], room["walls"] = [], []
    scene = scene_from_mapping(room)
    events = [event for _, event in simulate(scene, 1)]
    buffer = TransformBuffer()
    for event in events:
        if isinstance(event, StampedTransform):
            buffer.add(event)
    images = [event for event in events if isinstance(event, CameraImage)]
    assert {image.frame_id for image in images} == {frame}
    for image in images:  # none may lie beyond the last transform
        buffer.lookup("map", image.frame_id, image.stamp_ns)
    # At the end the robot is at (0.4, 0.2), turned by 30 degrees, camera 0.1 m ahead of it.
    last = buffer.lookup("map", frame, images[-1].stamp_ns)
    cosine, sine = np.cos(np.radians(30.0)), np.sin(np.radians(30.0))
    expected = [0.4 + 0.1 * cosine, 0.2 + 0.1 * sine, 1.2]
    np.testing.assert_allclose(last.translation_m, expected, atol=2e-3)
    forward = [1.0, 0.0, 0.0] if frame == "camera_link" else [0.0, 0.0, 1.0]
    np.testing.assert_allclose(last.rotate(forward), [cosine, sine, 0.0], atol=2e-3)
    for scan in (event for event in events if isinstance(event, Scan)):
        pose = buffer.lookup("map", scan.frame_id, scan.stamp_ns)
        angles, ranges = scan.angles_rad[scan.valid], scan.ranges_m[scan.valid]
        points = np.stack([ranges * np.cos(angles), ranges * np.sin(angles), 0 * ranges], -1)
        hits = pose.apply(points)
        np.testing.assert_allclose(hits[:, 2], 0.25)
        legs = people_at(scene, scan.stamp_ns / 1e9 - scene.start_s).legs.reshape(-1, 3)
        away = np.linalg.norm(hits[:, None, :2] - legs[None, :, :2], axis=-1).min(axis=1)
        np.testing.assert_allclose(away, 0.07, atol=1e-6)


def test_the_truth_follows_the_scene_file(scene):
    truths = [event for _, event in simulate(scene, 1) if isinstance(event, Truth)]
    since_s = np.array([truth.stamp_ns for truth in truths]) / 1e9 - scene.start_s
    up = np.array([truth.hand_up for truth in truths])
    np.testing.assert_array_equal(truths[0].id, [4, 9])
    assert not up[:, 0].any()
    np.testing.assert_array_equal(up[:, 1], (since_s > 0.5 - 1e-6) & (since_s < 1.2 - 1e-6))
    walked = np.array([truth.xy_m[0] for truth in truths])
    np.testing.assert_allclose(walked[:, 0], 2.0)
    np.testing.assert_allclose(walked[:, 1], 0.4 + since_s / 2.0, atol=1e-6)


def test_a_negative_seed_is_refused(scene):
    with pytest.raises(SceneError, match="seed is -1"):
        next(simulate(scene, -1))


def test_a_written_scene_reads_back_and_is_the_same_file_again(brief, tmp_path):
    shares = []
    first, second = tmp_path / "one" / "room.mcap", tmp_path / "two" / "room.mcap"
    write_simulation(brief, first, 5, shares.append)
    write_simulation(brief, second, 5)
    assert first.read_bytes() == second.read_bytes()
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    played = [event for _, event in simulate(brief, 5)]
    with open_recording(first, with_truth=True) as recording:
        read = [event for _, event in recording.events()]
    for kind in (CameraImage, Scan, Truth, CameraModel):
        ours, theirs = ([e for e in events if isinstance(e, kind)] for events in (played, read))
        assert len(ours) == len(theirs)
        if kind is CameraImage:
            np.testing.assert_array_equal(ours[-1].bgr, theirs[-1].bgr)
        if kind is CameraModel:
            assert (ours[0].fx, ours[0].cy) == (theirs[0].fx, theirs[0].cy)
        if kind is Truth:
            np.testing.assert_array_equal(ours[-1].in_view, theirs[-1].in_view)
            np.testing.assert_array_equal(ours[-1].hand_up, theirs[-1].hand_up)
    names = {event.child for event in read if isinstance(event, StampedTransform)}
    assert names == {"odom", "base_link", "camera_link", "laser"}
