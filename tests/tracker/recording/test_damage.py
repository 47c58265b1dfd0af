import sqlite3

import pytest

from tracker.containers import CameraImage
from tracker.errors import RecordingError
from tracker.recording import RecordingWriter, open_recording


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
    assert "ends or breaks" in error
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
    assert "What came before was read" in error


def test_an_mcap_cut_before_its_first_message_is_refused(drive):
    drive.write_bytes(drive.read_bytes()[:300])
    with pytest.raises(RecordingError, match="Nothing of it is left"):
        open_recording(drive)


def test_a_hole_in_the_middle_ends_the_stream_with_its_time(drive):
    content = bytearray(drive.read_bytes())
    middle = len(content) // 2
    content[middle : middle + 3000] = b"\xa5" * 3000
    drive.write_bytes(content)
    events, error = collect(drive)
    assert 10 < sum(isinstance(event, CameraImage) for event in events) < 40
    assert "is damaged" in error
    assert " s after its beginning" in error


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


def test_a_cut_database_is_refused_with_the_remedy(tmp_path):
    path = tmp_path / "drive.db3"
    database = sqlite3.connect(path)
    database.execute("CREATE TABLE topics (id INTEGER PRIMARY KEY, name TEXT)")
    database.execute("CREATE TABLE messages (id INTEGER PRIMARY KEY, data BLOB)")
    database.executemany("INSERT INTO messages (data) VALUES (?)", [(bytes(5000),)] * 50)
    database.commit()
    database.close()
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    with pytest.raises(RecordingError, match="recover") as caught:
        open_recording(path)
    assert str(path) in str(caught.value)
