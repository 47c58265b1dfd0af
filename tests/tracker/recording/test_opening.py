import re

import pytest

from tracker.errors import RecordingError
from tracker.recording import open_recording


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("missing.mcap", None, "no such file"),
        ("notes.txt", b"hello", "no supported format; supported are .avi"),
        ("drive", None, "no such file"),
        ("empty.mcap", b"", "seems to be empty"),
        ("empty.db3", b"", "rosbag2 database"),
        ("empty.bag", b"", "rosbag reindex"),
        ("empty.mp4", b"", "OpenCV cannot read a video"),
        ("empty.jpg", b"", "not one photo"),
        ("text.mcap", b"not an mcap file at all, but long enough" * 9, "cannot be read"),
        ("text.db3", b"not a database at all, but long enough" * 99, "sqlite3 old.db3"),
        ("text.bag", b"not a bag at all, but long enough" * 99, "rosbag reindex"),
        ("text.mp4", b"not a video at all, but long enough" * 99, "OpenCV cannot read a video"),
    ],
)
def test_what_is_no_recording_is_refused_in_one_line_with_its_name(tmp_path, name, content, words):
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(RecordingError, match=words) as caught:
        open_recording(path)
    assert str(path.parent) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_folders_without_anything_usable_are_refused(tmp_path):
    with pytest.raises(RecordingError, match="neither a rosbag2 recording nor photos"):
        open_recording(tmp_path)
    (tmp_path / "metadata.yaml").write_text("nothing: here")
    with pytest.raises(RecordingError, match=re.escape("ros2 bag reindex")):
        open_recording(tmp_path)
    (tmp_path / "metadata.yaml").write_text(": : no yaml [")
    with pytest.raises(RecordingError, match=re.escape("ros2 bag reindex")):
        open_recording(tmp_path)
