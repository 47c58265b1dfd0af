from pathlib import Path

import numpy as np
import pytest
import yaml
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader

from tracker.containers import CameraImage, Pose, Tracks
from tracker.errors import RecordingError
from tracker.messages import encode_markers
from tracker.recording import RecordingWriter, open_recording


def write_all(path, items, **options):
    with RecordingWriter(path, **options) as writer:
        for topic, log_ns, item in items:
            writer.write(topic, log_ns, item)


@pytest.mark.parametrize("name", ["drive.mcap", "drive"], ids=["file", "folder"])
def test_rosbags_reads_every_message_in_order_with_types_and_qos(tmp_path, sensor_items, name):
    write_all(tmp_path / name, sensor_items())

    with AnyReader([tmp_path / name]) as reader:  # brings no types along: they are in the file
        assert {topic: info.msgcount for topic, info in reader.topics.items()} == {
            "/image_raw": 20, "/camera_info": 20, "/scan": 20, "/tf": 20, "/truth/people": 20,
            "/tf_static": 1,
        }  # fmt: skip
        messages = [(log, reader.deserialize(raw, c.msgtype)) for c, log, raw in reader.messages()]
        profiles = {c.topic: c.ext.offered_qos_profiles for c in reader.connections}
    assert [log for log, _ in messages] == sorted(log for log, _ in messages)
    assert messages[0][1].encoding == "bgr8"
    (lasting,), (image,) = profiles["/tf_static"], profiles["/image_raw"]
    assert lasting.durability.name == "TRANSIENT_LOCAL"
    assert lasting.reliability.name == "RELIABLE"
    assert lasting.depth == 100
    assert image.durability.name == "VOLATILE"


def test_the_mcap_library_finds_profile_schemas_statistics_and_order(tmp_path, sensor_items):
    path = tmp_path / "drive.mcap"
    write_all(path, sensor_items())

    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        assert reader.get_header().profile == "ros2"
        summary = reader.get_summary()
        assert summary.statistics.message_count == 101
        assert len(summary.chunk_indexes) > 1
        for channel in summary.channels.values():
            assert channel.message_encoding == "cdr"
            assert channel.metadata["topic_type_hash"].startswith("RIHS01_")
        for schema in summary.schemas.values():
            assert schema.encoding == "ros2msg"
        logs = [message.log_time for _, _, message in reader.iter_messages()]
        (record,) = reader.iter_metadata()
    assert logs == sorted(logs)
    assert record.name == "rosbag2"
    assert yaml.safe_load(record.metadata["serialized_metadata"])["version"] == 8


def test_a_schema_holds_the_definitions_of_all_types_inside(tmp_path):
    path = tmp_path / "tracks.mcap"
    write_all(
        path, [("/tracks", 5, Tracks.none(5)), ("/markers", 5, encode_markers(Tracks.none(5)))]
    )
    with path.open("rb") as file:
        schemas = {
            s.name: s.data.decode() for s in make_reader(file).get_summary().schemas.values()
        }
    text = schemas["vision_msgs/msg/Detection3DArray"]
    assert text.startswith("std_msgs/Header header\n")
    inside = [line.removeprefix("MSG: ") for line in text.splitlines() if line.startswith("MSG: ")]
    assert {"vision_msgs/Detection3D", "geometry_msgs/Pose", "builtin_interfaces/Time"} <= set(
        inside
    )
    assert len(inside) == len(set(inside))


def test_the_folder_has_the_metadata_that_rosbag2_expects(tmp_path, sensor_items):
    write_all(tmp_path / "drive", sensor_items())

    text = (tmp_path / "drive/metadata.yaml").read_text()
    info = yaml.safe_load(text)["rosbag2_bagfile_information"]

    assert "&" not in text  # references are legal YAML, and surprise people
    assert info["version"] == 8
    assert info["storage_identifier"] == "mcap"
    assert info["relative_file_paths"] == ["drive_0.mcap"]
    assert (tmp_path / "drive/drive_0.mcap").exists()
    assert info["message_count"] == info["files"][0]["message_count"] == 101
    assert info["starting_time"]["nanoseconds_since_epoch"] == 1_700_000_000_005_000_000
    assert info["duration"]["nanoseconds"] == 1_995_000_000
    topic = next(
        t for t in info["topics_with_message_count"] if t["topic_metadata"]["name"] == "/tf_static"
    )
    assert topic["message_count"] == 1
    (profile,) = yaml.safe_load(topic["topic_metadata"]["offered_qos_profiles"])
    assert (profile["durability"], profile["reliability"], profile["history"]) == (1, 1, 1)


@pytest.mark.parametrize("name", ["drive.mcap", "drive"], ids=["file", "folder"])
def test_the_same_input_gives_the_same_bytes(tmp_path, sensor_items, name):
    contents = []
    for run in ("first", "second"):
        (tmp_path / run).mkdir()
        path = tmp_path / run / name
        write_all(path, sensor_items())
        files = [path] if path.is_file() else sorted(path.iterdir())
        contents.append([file.read_bytes() for file in files])
    assert contents[0] == contents[1]


def test_what_was_written_before_an_exception_can_be_read(tmp_path):
    path = tmp_path / "broken.mcap"

    def write_and_fail():
        with RecordingWriter(path) as writer:
            writer.write("/hand_raised", 5, True)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        write_and_fail()
    with AnyReader([path]) as reader:
        assert reader.message_count == 1


def test_an_empty_recording_is_one_too(tmp_path):
    for name in ("empty.mcap", "empty"):
        RecordingWriter(tmp_path / name).close()
        with open_recording(tmp_path / name) as recording:
            assert list(recording.events()) == []
            assert recording.summary.duration_s == 0.0


def test_jpegs_go_where_image_transport_puts_them(tmp_path):
    bgr = np.full((48, 64, 3), 120, dtype=np.uint8)
    path = tmp_path / "small.mcap"
    write_all(path, [("/image_raw", 5, CameraImage(5, "camera", bgr))], jpeg_quality=80)
    with open_recording(path) as recording:
        assert list(recording.topics) == ["/image_raw/compressed"]
        ((log_ns, image),) = recording.events()
    assert (log_ns, image.stamp_ns, image.width) == (5, 5, 64)


def test_an_existing_recording_is_replaced_only_when_asked(tmp_path):
    for name in ("old.mcap", "old"):
        write_all(tmp_path / name, [("/hand_raised", 5, True)])
        with pytest.raises(RecordingError, match="exists already"):
            RecordingWriter(tmp_path / name)
        write_all(tmp_path / name, [("/hand_raised", 5, True)] * 2, overwrite=True)
        with AnyReader([tmp_path / name]) as reader:
            assert reader.message_count == 2


def test_a_file_is_never_replaced_by_a_folder_nor_the_other_way(tmp_path):
    (tmp_path / "notes").write_text("keep me")
    (tmp_path / "folder.mcap").mkdir()
    for name in ("notes", "folder.mcap"):
        with pytest.raises(RecordingError, match="in the way"):
            RecordingWriter(tmp_path / name, overwrite=True)
    assert (tmp_path / "notes").read_text() == "keep me"


def test_a_place_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(RecordingError, match=r"file/out\.mcap: cannot be written"):
        RecordingWriter(tmp_path / "file" / "out.mcap")
    if Path("/dev/full").exists():
        (tmp_path / "full.mcap").symlink_to("/dev/full")
        writer = RecordingWriter(tmp_path / "full.mcap", overwrite=True)
        writer.write("/hand_raised", 5, True)
        with pytest.raises(RecordingError, match="space on the disk"):
            writer.close()


def test_misuse_is_refused(tmp_path):
    pose = Pose(5, "map", (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    with RecordingWriter(tmp_path / "out.mcap") as writer:
        writer.write("/hand_raised", 5, True)
        with pytest.raises(RecordingError, match="one type"):
            writer.write("/hand_raised", 6, pose)
        with pytest.raises(RecordingError, match="begins at 0"):
            writer.write("/hand_raised", -1, True)
        with pytest.raises(RecordingError, match="no ROS message"):
            writer.write("/hand_raised", 6, 3)
    writer.close()
    with pytest.raises(RecordingError, match="is closed"):
        writer.write("/hand_raised", 7, True)
