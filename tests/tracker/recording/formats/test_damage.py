import sqlite3

import pytest
import zstandard
from mcap.writer import Writer
from rosbags.rosbag1 import Writer as Ros1Writer
from rosbags.typesys import Stores, get_typestore

from tracker.containers import CameraImage, Scan
from tracker.errors import RecordingError
from tracker.messages import definition, encode
from tracker.messages.types import deserialize
from tracker.recording import RecordingWriter, open_recording
from tracker.recording.formats.unpacking import LARGEST_BYTES, DamagedError, unpack


def write_mcap(path, items, **settings):
    """With the settings of the mcap library's writer."""
    with path.open("wb") as file:
        writer, channels = Writer(file, **settings), {}
        writer.start(profile="ros2", library="test")
        for topic, log_ns, item in items:
            type_name, cdr = encode(item)
            if topic not in channels:
                schema = writer.register_schema(
                    type_name, "ros2msg", definition(type_name).encode()
                )
                channels[topic] = writer.register_channel(topic, "cdr", schema)
            writer.add_message(channels[topic], log_ns, bytes(cdr), log_ns)
        writer.finish()


@pytest.fixture
def drive(tmp_path, sensor_items):
    path = tmp_path / "drive.mcap"
    with RecordingWriter(path) as writer:
        for topic, log_ns, item in sensor_items(60):
            writer.write(topic, log_ns, item)
    return path


def collect(path):
    """What came, and the error that ended it."""
    events, error = [], ""
    with open_recording(path) as recording:
        try:
            events.extend(event for _, event in recording.events())
        except RecordingError as caught:
            error = str(caught)
    assert "\n" not in error
    return events, error


@pytest.mark.parametrize("share", [0.4, 0.7, 0.95])
def test_an_mcap_that_was_cut_off_is_read_up_to_there(drive, share):
    whole, _ = collect(drive)
    content = drive.read_bytes()
    drive.write_bytes(content[: int(len(content) * share)])

    events, error = collect(drive)

    images = [event for event in events if isinstance(event, CameraImage)]
    assert 60 * share - 20 < len(images) <= 60 * share + 1  # a chunk holds 18 images
    assert "was cut off or never finished" in error
    assert str(drive) in error
    stamps = [event.stamp_ns for event in whole if isinstance(event, CameraImage)]
    assert [image.stamp_ns for image in images] == stamps[: len(images)]


def test_an_mcap_that_lost_only_its_index_is_whole(drive):
    whole, _ = collect(drive)
    content = drive.read_bytes()
    drive.write_bytes(content[:-40])
    events, error = collect(drive)
    assert len(events) == len(whole)
    assert events[0].is_static
    assert "What could be read was read" in error


def test_an_mcap_cut_before_its_first_message_is_refused(drive):
    drive.write_bytes(drive.read_bytes()[:300])
    with pytest.raises(RecordingError, match="before its first message"):
        open_recording(drive)


def hole(content, at):
    return content[:at] + b"\xa5" * 3000 + content[at + 3000 :]


def flip(content, at):
    return content[:at] + bytes([content[at] ^ 0x40]) + content[at + 1 :]


def insert(content, at):
    return content[:at] + b"\x05\x00\x00\x00\x07" * 7 + content[at:]


def delete(content, at):
    return content[:at] + content[at + 11 :]


@pytest.mark.parametrize("share", [0.35, 0.6])
@pytest.mark.parametrize("harm", [hole, flip, insert, delete])
def test_damage_in_the_middle_costs_a_chunk_and_is_told_with_its_time(drive, harm, share):
    content = drive.read_bytes()
    drive.write_bytes(harm(content, int(len(content) * share)))
    events, error = collect(drive)
    images = [event.stamp_ns for event in events if isinstance(event, CameraImage)]
    assert 60 - 19 <= len(images) < 60  # a chunk holds 18 images
    assert images[-1] - images[0] == 59 * 10**8
    assert images == sorted(images)
    assert " s after its beginning" in error
    assert f"{len(images)} of 60 on /image_raw" in error


@pytest.mark.parametrize("harm", [hole, flip, insert, delete])
def test_without_chunks_damage_costs_the_messages_it_hits(tmp_path, sensor_items, harm):
    path = tmp_path / "drive.mcap"
    write_mcap(path, sensor_items(60), use_chunking=False)
    content = path.read_bytes()
    path.write_bytes(harm(content, len(content) // 2 + 30_000))
    events, _ = collect(path)
    assert sum(isinstance(event, CameraImage) for event in events) >= 58
    assert sum(isinstance(event, Scan) for event in events) >= 59


def test_a_chunk_that_claims_to_be_huge_is_told_and_the_rest_read(drive):
    content = drive.read_bytes()
    at = content.index(b"\x03\x00\x00\x00lz4", len(content) // 2) - 12
    drive.write_bytes(content[:at] + (10**10).to_bytes(8, "little") + content[at + 8 :])
    events, error = collect(drive)
    assert sum(isinstance(event, CameraImage) for event in events) >= 60 - 19
    assert "claims 10000000000 bytes" in error


def test_a_bomb_in_a_chunk_stays_packed():
    bomb = zstandard.compress(bytes(LARGEST_BYTES + 10**6))
    assert len(bomb) < 10**5
    for size in (None, 1000):
        with pytest.raises(DamagedError, match="does not decompress to"):
            unpack(bomb, "zstd", size)


def test_log_times_that_cannot_be_are_passed_over(tmp_path, sensor_items):
    items = [(topic, log_ns, item) for topic, log_ns, item in sensor_items(5)]
    write_mcap(tmp_path / "a.mcap", [*items, ("/scan", 2**64 - 1, items[2][2])])
    events, error = collect(tmp_path / "a.mcap")
    assert sum(isinstance(event, Scan) for event in events) == 5
    assert "5 of 6 on /scan" in error


def test_a_folder_of_a_killed_recorder_is_read_file_by_file(tmp_path, sensor_items):
    folder = tmp_path / "killed"
    items = list(sensor_items(40))
    parts = [items[:100], items[100:]]
    for number, part in enumerate(parts):
        with RecordingWriter(folder / f"killed_{number}.mcap") as writer:
            for topic, log_ns, item in part:
                writer.write(topic, log_ns, item)
    with open_recording(folder) as recording:
        (note,) = recording.notes
        assert "metadata.yaml is missing" in note
        assert recording.topics["/image_raw"].count == 40
        events = list(recording.events())
        assert events[0][1].is_static
        logs = [log_ns for log_ns, _ in events]
        assert logs == sorted(logs)
    last = folder / "killed_1.mcap"
    last.write_bytes(last.read_bytes()[:-5000])
    events, error = collect(folder)
    assert "killed_1.mcap" in error
    assert len(events) > 60


@pytest.fixture
def database(tmp_path, sensor_items):
    path = tmp_path / "drive.db3"
    database = sqlite3.connect(path)
    database.execute("CREATE TABLE topics (id INTEGER PRIMARY KEY, name TEXT, type TEXT)")
    database.execute(
        "CREATE TABLE messages (id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, "
        "data BLOB)"
    )
    topics = {}
    for topic, log_ns, item in sensor_items(60):
        type_name, cdr = encode(item)
        if topic not in topics:
            topics[topic] = len(topics) + 1
            row = (topics[topic], topic, type_name)
            database.execute("INSERT INTO topics VALUES (?, ?, ?)", row)
        row = (topics[topic], log_ns, bytes(cdr))
        database.execute("INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)", row)
    database.commit()
    database.close()
    return path


@pytest.mark.parametrize("share", [0.3, 0.7])
def test_a_database_that_was_cut_off_is_read_as_far_as_it_goes(database, share):
    content = database.read_bytes()
    database.write_bytes(content[: int(len(content) * share)])
    events, error = collect(database)
    assert sum(isinstance(event, CameraImage) for event in events) > 60 * share - 5
    assert "is damaged" in error


def test_a_damaged_page_of_a_database_costs_its_rows(database):
    content = bytearray(database.read_bytes())
    first = content.index(b"camera_link") // 4096 * 4096
    page = next(
        at for at in range(first + 90 * 4096, len(content), 4096) if content[at] == 0x0D
    )  # a leaf of the table
    content[page : page + 4096] = b"\xff" * 4096
    database.write_bytes(content)
    events, error = collect(database)
    assert 50 <= sum(isinstance(event, CameraImage) for event in events) <= 60
    assert "malformed" in error


def test_a_database_of_something_else_is_refused(tmp_path):
    path = tmp_path / "shop.db3"
    database = sqlite3.connect(path)
    database.execute("CREATE TABLE goods (id INTEGER PRIMARY KEY)")
    database.close()
    with pytest.raises(RecordingError, match="recover") as caught:
        open_recording(path)
    assert str(path) in str(caught.value)


@pytest.fixture(params=["none", "lz4", "bz2"])
def bag(request, tmp_path, sensor_items):
    """A ROS 1 bag of scans, 20 chunks."""
    path = tmp_path / "drive.bag"
    store = get_typestore(Stores.ROS1_NOETIC)
    writer = Ros1Writer(path)
    if request.param != "none":
        writer.set_compression(Ros1Writer.CompressionFormat[request.param.upper()])
    writer.chunk_threshold = 2000
    with writer:
        connection = None
        for topic, log_ns, item in sensor_items(60):
            if topic != "/scan":
                continue
            message = deserialize(*encode(item))
            header = store.types["std_msgs/msg/Header"](0, message.header.stamp, "laser")
            fields = {**vars(message), "header": header}
            fields.pop("__msgtype__", None)
            scan = store.types["sensor_msgs/msg/LaserScan"](**fields)
            if connection is None:
                connection = writer.add_connection(topic, scan.__msgtype__, typestore=store)
            writer.write(connection, log_ns, store.serialize_ros1(scan, scan.__msgtype__))
    return path


def test_a_bag_without_its_index_is_read(bag):
    content = bag.read_bytes()
    bag.write_bytes(content[: content.rindex(b"chunk_pos=") - 900])
    events, error = collect(bag)
    assert len(events) >= 55
    assert "What could be read was read" in error


@pytest.mark.parametrize("harm", [flip, insert, delete])
def test_damage_to_a_bag_costs_a_chunk(bag, harm):
    content = bag.read_bytes()
    bag.write_bytes(harm(content, len(content) // 2))
    events, _ = collect(bag)
    assert len(events) >= 50


def test_a_folder_of_several_recordings_wants_one_of_them_named(tmp_path, sensor_items):
    for name in ("kitchen", "hall_0", "hall_1"):
        with RecordingWriter(tmp_path / f"{name}.mcap") as writer:
            for topic, log_ns, item in sensor_items(2):
                writer.write(topic, log_ns, item)
    with pytest.raises(RecordingError, match=r"several recordings, .*kitchen.mcap.*name one"):
        open_recording(tmp_path)
