from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from rosbags.rosbag1 import Writer as Ros1Writer
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Ros2Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from tracker.camera import CameraModel
from tracker.containers import CameraImage, Scan, Truth
from tracker.errors import RecordingError
from tracker.messages import encode
from tracker.messages.types import build, deserialize, serialize, typestore
from tracker.recording import RecordingWriter, Topics, open_recording
from tracker.transforms import StampedTransform

SCANS = Path(__file__).parents[3] / "../shared/data/scans"


def write_mcap(path, items):
    with RecordingWriter(path) as writer:
        for topic, log_ns, item in items:
            writer.write(topic, log_ns, item)


def write_sqlite(path, items, version=9):
    with Ros2Writer(path, version=version, storage_plugin=StoragePlugin.SQLITE3) as writer:
        connections = {}
        for topic, log_ns, item in items:
            type_name, cdr = encode(item)
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, type_name, typestore=typestore())
            writer.write(connections[topic], log_ns, cdr)


def as_ros1(store, message, type_name=None):
    """The same message of ROS 1, field by field; only its header has one more, `seq`."""
    if isinstance(message, list):
        return [as_ros1(store, part) for part in message]
    if not hasattr(message, "__msgtype__"):
        return message
    type_name = type_name or message.__msgtype__
    names = [name for name, _ in store.fielddefs[type_name][1]]
    values = {name: as_ros1(store, getattr(message, name, 0)) for name in names}
    return store.types[type_name](**values)


def write_ros1(path, items, rename=()):
    store = get_typestore(Stores.ROS1_NOETIC)
    definition = "geometry_msgs/TransformStamped[] transforms\n"
    for name in ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage"):
        store.register(get_types_from_msg(definition, name))
    with Ros1Writer(path) as writer:
        connections = {}
        for topic, log_ns, item in items:
            message = deserialize(*encode(item))
            type_name = dict(rename).get(message.__msgtype__, message.__msgtype__)
            if topic in ("/camera_info", "/truth/people"):  # spelled otherwise, and unknown
                continue
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, type_name, typestore=store)
            raw = store.serialize_ros1(as_ros1(store, message, type_name), type_name)
            writer.write(connections[topic], log_ns, raw)


def kinds(events):
    return Counter(type(event).__name__ for _, event in events)


@pytest.mark.parametrize("kind", ["mcap file", "mcap folder", "db3 folder", "db3 file"])
def test_every_kind_of_ros2_recording_gives_the_same_stream(tmp_path, sensor_items, kind):
    path = tmp_path / ("drive.mcap" if kind == "mcap file" else "drive")
    write = write_sqlite if kind.startswith("db3") else write_mcap
    write(path, sensor_items())
    path = next(path.glob("*.db3")) if kind == "db3 file" else path

    with open_recording(path) as recording:
        events = list(recording.events())
        assert recording.has_images
        assert recording.has_scans
        assert recording.has_camera_info
        assert recording.has_transforms
        assert recording.has_truth
        assert recording.is_bag
        assert recording.notes == []
        assert recording.skipped_lines() == []
        assert recording.summary.duration_s == pytest.approx(1.995)

    assert kinds(events) == {
        "StampedTransform": 21,
        "CameraImage": 20,
        "CameraModel": 20,
        "Scan": 20,
    }
    wanted = [item for topic, _, item in sensor_items() if topic == "/image_raw"]
    images = [event for _, event in events if isinstance(event, CameraImage)]
    for image, original in zip(images, wanted, strict=True):
        assert image.stamp_ns == original.stamp_ns
        np.testing.assert_array_equal(image.bgr, original.bgr)


def test_ros1_bags_give_the_same_stream(tmp_path, sensor_items):
    write_ros1(tmp_path / "drive.bag", sensor_items())
    with open_recording(tmp_path / "drive.bag") as recording:
        events = list(recording.events())
        assert recording.summary.kind == "ROS 1 bag"
        assert recording.skipped == {}
    assert kinds(events) == {"StampedTransform": 21, "CameraImage": 20, "Scan": 20}
    assert events[0][1].is_static
    image = next(item for topic, _, item in sensor_items() if topic == "/image_raw")
    np.testing.assert_array_equal(events[1][1].bgr, image.bgr)


def test_transforms_of_the_oldest_tf_are_understood(tmp_path, sensor_items):
    rename = {"tf2_msgs/msg/TFMessage": "tf/msg/tfMessage"}
    write_ros1(tmp_path / "old.bag", sensor_items(), rename)
    with open_recording(tmp_path / "old.bag") as recording:
        assert kinds(recording.events())["StampedTransform"] == 21


def test_events_come_in_log_time_order_though_written_otherwise(tmp_path, sensor_items):
    items = list(sensor_items())
    order = np.random.default_rng(3).permutation(len(items))
    write_mcap(tmp_path / "shuffled.mcap", [items[row] for row in order])
    with open_recording(tmp_path / "shuffled.mcap", with_truth=True) as recording:
        logs = [log_ns for log_ns, _ in recording.events()]
    assert len(logs) == len(items)
    assert logs == sorted(logs)


def test_late_lasting_transforms_come_first_and_once(tmp_path, sensor_items):
    write_mcap(tmp_path / "drive.mcap", sensor_items())
    with open_recording(tmp_path / "drive.mcap") as recording:
        events = [event for _, event in recording.events()]
    is_static = [isinstance(event, StampedTransform) and event.is_static for event in events]
    assert is_static == [True] + [False] * (len(events) - 1)


def test_truth_comes_only_when_asked_for(tmp_path, sensor_items):
    write_mcap(tmp_path / "drive.mcap", sensor_items())
    with open_recording(tmp_path / "drive.mcap") as recording:
        assert "Truth" not in kinds(recording.events())
    with open_recording(tmp_path / "drive.mcap", with_truth=True) as recording:
        truths = [event for _, event in recording.events() if isinstance(event, Truth)]
    assert len(truths) == 20
    assert truths[0].in_view.tolist() == [True]


def test_events_can_be_read_twice(tmp_path, sensor_items):
    write_mcap(tmp_path / "drive.mcap", sensor_items())
    with open_recording(tmp_path / "drive.mcap") as recording:
        first = kinds(recording.events())
        assert kinds(recording.events()) == first


def test_progress_runs_from_0_to_1(tmp_path, sensor_items):
    write_mcap(tmp_path / "drive.mcap", sensor_items())
    with open_recording(tmp_path / "drive.mcap") as recording:
        shares = [recording.share(log_ns) for log_ns, _ in recording.events()]
        assert recording.share(recording.summary.start_ns + 10**12) == 1.0
    assert shares == sorted(shares)
    assert shares[0] == 0.0
    assert shares[-1] == pytest.approx(0.95, abs=0.01)


def test_header_stamps_far_from_the_log_are_noted_and_can_be_replaced(tmp_path):
    scans = [
        ("/scan", 10**12 + i * 10**8, Scan(i * 10**8, "laser", 0.0, 0.1, 0.1, 9.0, np.ones(9)))
        for i in range(5)
    ]
    write_mcap(tmp_path / "offset.mcap", scans)
    with open_recording(tmp_path / "offset.mcap") as recording:
        (note,) = recording.notes
        assert "-1000.000 s" in note
        assert [event.stamp_ns for _, event in recording.events()] == [
            0,
            *range(10**8, 5 * 10**8, 10**8),
        ]
    with open_recording(tmp_path / "offset.mcap", stamps="log") as recording:
        assert all(event.stamp_ns == log_ns for log_ns, event in recording.events())
    with pytest.raises(RecordingError, match="header or log"):
        open_recording(tmp_path / "offset.mcap", stamps="wall")


def test_missing_images_are_explained_with_the_topics_there_are(tmp_path, sensor_items):
    items = [
        (topic.replace("/image_raw", "/front/image"), log, item)
        for topic, log, item in sensor_items()
    ]
    write_mcap(tmp_path / "front.mcap", items)
    with open_recording(tmp_path / "front.mcap") as recording:
        assert not recording.has_images
        with pytest.raises(RecordingError) as caught:
            recording.require_images()
        assert "no images on /image_raw; the recording contains /camera_info" in str(caught.value)
        assert "--image-topic /front/image" in str(caught.value)
        assert "CameraImage" not in kinds(recording.events())
    with open_recording(tmp_path / "front.mcap", Topics(image="/front/image")) as recording:
        recording.require_images()
        assert kinds(recording.events())["CameraImage"] == 20


def test_usual_neighbors_of_missing_topics_are_found_and_noted(tmp_path, sensor_items):
    names = {
        "/image_raw": "/eye/image",
        "/camera_info": "/eye/camera_info",
        "/scan": "/laser/scan",
    }
    items = [(names.get(topic, topic), log, item) for topic, log, item in sensor_items()]
    write_mcap(tmp_path / "other.mcap", items)
    with open_recording(tmp_path / "other.mcap", Topics(image="/eye/image")) as recording:
        assert kinds(recording.events()) == {
            "StampedTransform": 21, "CameraImage": 20, "CameraModel": 20, "Scan": 20,
        }  # fmt: skip
        assert any("/laser/scan is read instead" in note for note in recording.notes)
        assert any("/eye/camera_info is read instead" in note for note in recording.notes)


def test_two_unknown_scanners_are_not_guessed_between(tmp_path, sensor_items):
    scans = [item for topic, _, item in sensor_items() if topic == "/scan"]
    items = [(topic, scan.stamp_ns, scan) for scan in scans for topic in ("/left", "/right")]
    write_mcap(tmp_path / "two.mcap", items)
    with open_recording(tmp_path / "two.mcap") as recording:
        assert not recording.has_scans
        assert list(recording.events()) == []


def test_a_topic_of_another_type_is_not_taken_for_scans(tmp_path):
    write_mcap(tmp_path / "odd.mcap", [("/scan", 5, True)])
    with open_recording(tmp_path / "odd.mcap") as recording:
        assert not recording.has_scans
        assert list(recording.events()) == []


def test_broken_messages_are_counted_and_the_first_is_told(tmp_path, sensor_items):
    broken = serialize(build("sensor_msgs/msg/Image", encoding="bgr8", height=4, width=4))
    uncalibrated = serialize(build("sensor_msgs/msg/CameraInfo"))
    items = list(sensor_items())
    start_ns = items[0][1]
    extra = [("/image_raw", start_ns + 10**9 + i, broken) for i in range(3)]
    write_mcap(tmp_path / "some.mcap", [*items, *extra, ("/camera_info", start_ns, uncalibrated)])
    with open_recording(tmp_path / "some.mcap") as recording:
        for _ in range(2):  # counted anew each time
            counts = kinds(recording.events())
            assert counts["CameraImage"] == 20
            assert recording.skipped["/image_raw"].count == 3
        camera, image = recording.skipped_lines()
    assert image.startswith("/image_raw: 3 unusable messages, the first: at 1.000 s: An image")
    assert "uncalibrated" in camera


def test_cdr_that_is_cut_off_is_counted(tmp_path, sensor_items):
    items = list(sensor_items(3))
    whole = encode(items[2][2])
    cut = whole._replace(cdr=whole.cdr[:-9])
    write_mcap(tmp_path / "cut.mcap", [*items, ("/scan", items[-1][1], cut)])
    with open_recording(tmp_path / "cut.mcap") as recording:
        assert kinds(recording.events())["Scan"] == 3
        assert recording.skipped["/scan"].count == 1


def test_intrinsics_arrive_as_a_camera_model(tmp_path, sensor_items):
    write_mcap(tmp_path / "drive.mcap", sensor_items(1))
    with open_recording(tmp_path / "drive.mcap") as recording:
        models = [event for _, event in recording.events() if isinstance(event, CameraModel)]
    assert [(model.fx, model.cy) for model in models] == [(100.0, 60.0)]


@pytest.mark.parametrize(
    ("name", "scans", "transforms", "topic"),
    [
        ("leg_tracker_demo", 1265, 0, "/scan"),
        ("leg_tracker__positive_1_extracted.bag", 197, 0, "/training_scan"),
        ("oko_slam_wraparound.bag", 22, 3143, "/scan"),
    ],
)
def test_recordings_of_real_scanners_replay(name, scans, transforms, topic):
    if not (SCANS / name).exists():
        pytest.skip("needs the recorded scans beside the checkout")
    with open_recording(SCANS / name) as recording:
        events = list(recording.events())
        assert recording.read_topics.scan == topic
        assert recording.skipped == {}
        with pytest.raises(RecordingError, match="no images"):
            recording.require_images()
    counts = kinds(events)
    assert (counts["Scan"], counts["StampedTransform"]) == (scans, transforms)
    assert [log for log, _ in events] == sorted(log for log, _ in events)
    assert any(event.valid.any() for _, event in events if isinstance(event, Scan))


@pytest.mark.parametrize("stamps", ["header", "log"])
def test_a_stamp_beyond_what_ros_can_say_is_counted_and_the_rest_is_read(
    tmp_path, sensor_items, stamps
):
    items = list(sensor_items(5))
    topic, log_ns, scan = items[2]
    message = deserialize(*encode(scan))
    message.header.stamp.sec, message.header.stamp.nanosec = 2**31 - 1, 2**32 - 1
    late_ns = 2**62 if stamps == "log" else log_ns
    write_mcap(tmp_path / "a.mcap", [*items, (topic, late_ns, serialize(message))])
    with open_recording(tmp_path / "a.mcap", stamps=stamps) as recording:
        assert kinds(recording.events())["Scan"] == 5
        assert "after 2038" in recording.skipped["/scan"].first
