"""Whatever a recording is called, packed or indexed like, all of it is read."""

import sqlite3
from collections import Counter

import pytest
import yaml
import zstandard
from mcap.writer import CompressionType, IndexType, Writer

from tracker.errors import RecordingError
from tracker.messages import definition, encode
from tracker.recording import RecordingWriter, open_recording

WHOLE = {"CameraImage": 12, "CameraModel": 12, "Scan": 12, "StampedTransform": 13}


def write_mcap(path, items, *, per_message=False, **settings):
    with path.open("wb") as file:
        writer, channels = Writer(file, **settings), {}
        writer.start(profile="ros2", library="test")
        for topic, log_ns, item in items:
            type_name, cdr = encode(item)
            if topic not in channels:
                text = definition(type_name).encode()
                schema = writer.register_schema(type_name, "ros2msg", text)
                channels[topic] = writer.register_channel(topic, "cdr", schema)
            data = zstandard.compress(bytes(cdr)) if per_message else bytes(cdr)
            writer.add_message(channels[topic], log_ns, data, log_ns)
        writer.finish()


def write_database(path, items):
    database = sqlite3.connect(path)
    database.execute("CREATE TABLE topics (id INTEGER PRIMARY KEY, name TEXT, type TEXT)")
    database.execute(
        "CREATE TABLE messages (id INTEGER PRIMARY KEY, topic_id INT, timestamp INT, data BLOB)"
    )
    topics = {}
    for topic, log_ns, item in items:
        type_name, cdr = encode(item)
        if topic not in topics:
            topics[topic] = len(topics)
            row = (topics[topic], topic, type_name)
            database.execute("INSERT INTO topics VALUES (?, ?, ?)", row)
        row = (topics[topic], log_ns, bytes(cdr))
        database.execute("INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)", row)
    database.commit()
    database.close()


def kinds(path):
    with open_recording(path) as recording:
        rows = list(recording.events())
        assert recording.skipped == {}
    logs = [log_ns for log_ns, _ in rows][1:]  # the lasting transform comes first
    assert logs == sorted(logs)
    return Counter(type(event).__name__ for _, event in rows)


@pytest.mark.parametrize(
    "settings",
    [
        {},
        {"compression": CompressionType.ZSTD},
        {"compression": CompressionType.NONE},
        {"use_chunking": False},
        {"use_chunking": False, "use_statistics": False, "index_types": IndexType.NONE},
        {"index_types": IndexType.CHUNK},
        {"index_types": IndexType.MESSAGE},
        {"index_types": IndexType.NONE, "use_summary_offsets": False},
        {"index_types": IndexType.CHUNK, "use_statistics": False},
        {"use_statistics": False},
        {"repeat_channels": False, "repeat_schemas": False},
        {"repeat_channels": False, "index_types": IndexType.CHUNK},
        {"enable_crcs": False, "index_types": IndexType.NONE, "chunk_size": 900},
        {"per_message": True},
    ],
    ids=lambda settings: ", ".join(settings) or "as usual",
)
def test_an_mcap_is_read_whatever_index_it_has(tmp_path, sensor_items, settings):
    write_mcap(tmp_path / "a.mcap", sensor_items(12), **settings)
    assert kinds(tmp_path / "a.mcap") == WHOLE


def test_chunks_that_overlap_in_time_are_brought_into_order(tmp_path, sensor_items):
    items = list(sensor_items(12))
    mixed = [*items[::2], *items[1::2]]
    write_mcap(tmp_path / "a.mcap", mixed, chunk_size=60_000)
    assert kinds(tmp_path / "a.mcap") == WHOLE


def test_two_files_in_one_are_read_one_after_the_other(tmp_path, sensor_items):
    items = list(sensor_items(12))
    for name, part in (("a", items[:30]), ("b", items[30:])):
        write_mcap(tmp_path / f"{name}.mcap", part)
    joined = (tmp_path / "a.mcap").read_bytes() + (tmp_path / "b.mcap").read_bytes()
    (tmp_path / "joined.mcap").write_bytes(joined)
    with open_recording(tmp_path / "joined.mcap") as recording:
        events = []
        try:
            events += [event for _, event in recording.events()]
        except RecordingError as error:
            pytest.fail(str(error))
    assert len(events) == sum(WHOLE.values())


@pytest.mark.parametrize(
    "name", ["a.MCAP", "a.Mcap", "a.mcap.zstd", "a.MCAP.ZSTD", "a.mcap.zst", "A.DB3", "a.db3.zstd"]
)
def test_names_in_capitals_and_packed_files_are_read(tmp_path, sensor_items, name):
    write = write_mcap if "mcap" in name.lower() else write_database
    write(tmp_path / "plain", sensor_items(12))
    content = (tmp_path / "plain").read_bytes()
    packed = "zst" in name.lower()
    (tmp_path / name).write_bytes(zstandard.compress(content) if packed else content)
    assert kinds(tmp_path / name) == WHOLE


@pytest.mark.parametrize("with_metadata", [True, False])
@pytest.mark.parametrize("name", ["drive_0.mcap.zstd", "drive_0.MCAP"])
def test_folders_of_packed_files_are_read_with_metadata_and_without(
    tmp_path, sensor_items, name, with_metadata
):
    folder = tmp_path / "drive"
    with RecordingWriter(folder) as writer:
        for topic, log_ns, item in sensor_items(12):
            writer.write(topic, log_ns, item)
    content = (folder / "drive_0.mcap").read_bytes()
    (folder / "drive_0.mcap").unlink()
    (folder / name).write_bytes(zstandard.compress(content) if "zstd" in name else content)
    metadata = folder / "metadata.yaml"
    if with_metadata:
        said = yaml.safe_load(metadata.read_text())
        said["rosbag2_bagfile_information"]["relative_file_paths"] = [name]
        metadata.write_text(yaml.safe_dump(said))
    else:
        metadata.unlink()
    assert kinds(folder) == WHOLE


def test_a_packed_file_is_named_as_the_user_calls_it(tmp_path, sensor_items):
    write_mcap(tmp_path / "a.mcap", sensor_items(12), chunk_size=100_000)
    content = (tmp_path / "a.mcap").read_bytes()
    path = tmp_path / "b.mcap.zstd"
    path.write_bytes(zstandard.compress(content[:-9000]))
    with open_recording(path) as recording:
        events = []
        with pytest.raises(RecordingError, match=r"b\.mcap\.zstd: was cut off"):
            events.extend(recording.events())
    path.write_bytes(zstandard.compress(b"something else" * 99))
    with pytest.raises(RecordingError, match=r"b\.mcap\.zstd: cannot be read"):
        open_recording(path)
    path.write_bytes(b"not packed at all" * 99)
    with pytest.raises(RecordingError, match=r"b\.mcap\.zstd: cannot be read"):
        open_recording(path)


def test_one_broken_file_of_a_folder_leaves_the_others_to_be_read(tmp_path, sensor_items):
    folder = tmp_path / "drive"
    folder.mkdir()
    items = list(sensor_items(12))
    write_mcap(folder / "drive_0.mcap", items[:30])
    (folder / "drive_1.mcap").write_bytes(b"\x00" * 5000)
    write_mcap(folder / "drive_2.mcap", items[30:])
    with open_recording(folder) as recording:
        events = []
        with pytest.raises(RecordingError, match=r"drive_1\.mcap: cannot be read"):
            events.extend(recording.events())
        assert recording.topics["/image_raw"].count == 12
    assert len(events) > 40


def test_more_messages_counted_than_read_is_said(tmp_path, sensor_items):
    path = tmp_path / "a.mcap"
    write_mcap(path, sensor_items(12), enable_crcs=False)
    content = path.read_bytes()
    scan = content.rindex(b"/scan")  # its channel, in the summary
    statistics = content.index(b"\x0b", scan)
    at = statistics + 9 + 46  # counts of channels: number, then eight bytes
    changed = bytearray(content)
    changed[at + 2] += 5
    path.write_bytes(changed)
    with open_recording(path) as recording, pytest.raises(RecordingError, match="12 of 17 on"):
        list(recording.events())
