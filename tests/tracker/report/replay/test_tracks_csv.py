import csv

import pytest

from tracker.errors import RecordingError
from tracker.report.replay.tracks_csv import COLUMNS, TracksCsv


def test_the_columns_are_those_others_rely_on(tmp_path):
    with TracksCsv(tmp_path / "tracks.csv"):
        pass
    assert (tmp_path / "tracks.csv").read_text() == (
        "stamp_s,track_id,x_m,y_m,vx_mps,vy_mps,var_x,var_xy,var_y,existence,raised,selected\n"
    )


def test_every_confirmed_customer_is_a_line(tmp_path, result_of):
    with TracksCsv(tmp_path / "tracks.csv") as table:
        table.write(result_of(5, (3, 1.25, -2.0, True), (4, 0.0, 0.5, False), selected=3))
        table.write(result_of(6))
    rows = list(csv.DictReader((tmp_path / "tracks.csv").read_text().splitlines()))
    assert [(row["track_id"], row["raised"], row["selected"]) for row in rows] == [
        ("3", "1", "1"),
        ("4", "0", "0"),
    ]
    assert {name: float(rows[0][name]) for name in COLUMNS} == {
        "stamp_s": 5e-9, "track_id": 3, "x_m": 1.25, "y_m": -2.0, "vx_mps": 0, "vy_mps": 0,
        "var_x": 0.04, "var_xy": 0.0, "var_y": 0.01, "existence": 0.9, "raised": 1, "selected": 1,
    }  # fmt: skip


def test_tentative_customers_are_left_out(tmp_path, results):
    with TracksCsv(tmp_path / "tracks.csv") as table:
        for result in results[:30]:
            table.write(result)
    rows = list(csv.DictReader((tmp_path / "tracks.csv").read_text().splitlines()))
    assert len(rows) == 6  # seen from image 20 on, confirmed from 24 on
    assert {row["track_id"] for row in rows} == {"1"}


@pytest.mark.parametrize(
    ("stamp_ns", "text"),
    [
        (1_700_000_000_123_456_789, "1700000000.123456789"),
        (1_000_000_001, "1.000000001"),
        (0, "0.000000000"),
    ],
    ids=["today", "leading zeros", "zero"],
)
def test_no_nanosecond_of_a_stamp_is_lost(tmp_path, result_of, stamp_ns, text):
    with TracksCsv(tmp_path / "tracks.csv") as table:
        table.write(result_of(stamp_ns, (1, 0.0, 0.0, True)))
    assert (tmp_path / "tracks.csv").read_text().splitlines()[1].split(",")[0] == text


def test_what_is_written_can_be_read_before_the_file_is_closed(tmp_path, result_of):
    table = TracksCsv(tmp_path / "tracks.csv")
    table.write(result_of(7, (1, 0.0, 0.0, True)))
    assert len((tmp_path / "tracks.csv").read_text().splitlines()) == 2
    table.close()


def test_a_folder_that_does_not_exist_is_named(tmp_path):
    with pytest.raises(RecordingError, match="nowhere"):
        TracksCsv(tmp_path / "nowhere" / "tracks.csv")


def test_a_full_disk_is_one_clear_line(result_of):
    with pytest.raises(RecordingError, match="cannot be written"):
        TracksCsv("/dev/full")
