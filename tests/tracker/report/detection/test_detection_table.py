import csv
import dataclasses
import io
import json

import cv2
import pytest
from rich.console import Console

from tracker.errors import RecordingError
from tracker.report.detection.detection_table import false_table, recall_table, write_detection


def printed(table):
    console = Console(width=120, file=io.StringIO())
    console.print(table)
    return console.file.getvalue()


def test_the_table_tells_recall_with_its_interval(detection_study):
    text = printed(recall_table(detection_study))
    line = next(line for line in text.splitlines() if "3 m" in line)
    assert "2 of 6" in line
    assert "33.3 %" in line
    assert "8 of 12" in text


def test_the_table_tells_what_fooled_the_detector(detection_study):
    text = printed(false_table(detection_study))
    line = next(line for line in text.splitlines() if "phone" in line)
    assert [cell.strip() for cell in line.split("│")[2:6]] == ["phone", "1", "0.05", "20.0"]
    assert "besides these, 1 in the" in text


def test_files_hold_every_episode_and_minute(detection_study, tmp_path):
    files = write_detection(detection_study, tmp_path / "out")
    assert [path.name for path in files] == [
        "evaluation.json", "episodes.csv", "minutes.csv", "evaluation.png",
    ]  # fmt: skip
    document, episodes, minutes, picture = files
    assert json.loads(document.read_text())["recall"]["found"] == 8
    rows = list(csv.DictReader(episodes.read_text().splitlines()))
    assert len(rows) == 12
    assert (rows[0]["images"], rows[0]["found"], rows[0]["distance_m"]) == ("2", "1", "1.0")
    assert (rows[11]["images"], rows[11]["found"], rows[11]["landmark_error"]) == ("", "0", "")
    rows = list(csv.DictReader(minutes.read_text().splitlines()))
    assert [row["false_raises"] for row in rows] == ["2", "0", "1"]
    assert rows[0]["of"] == "talk at 3.0 s; phone at 9.5 s"
    assert cv2.imread(str(picture)).shape[1] > 1000


@pytest.mark.parametrize("missing", ["episodes", "minutes"])
def test_a_half_of_the_study_may_be_left_out(detection_study, tmp_path, missing):
    half = dataclasses.replace(detection_study, **{missing: ()})
    files = write_detection(half, tmp_path)
    assert all(path.is_file() for path in files)
    assert printed(recall_table(half))
    assert printed(false_table(half))


def test_a_folder_that_cannot_be_written_is_named(detection_study, tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(RecordingError, match=r"file: cannot be written"):
        write_detection(detection_study, tmp_path / "file")
