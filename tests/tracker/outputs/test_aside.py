import os
from pathlib import Path

import pytest

from tracker.errors import OutputError
from tracker.outputs import GrowingFile, writing_into


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_files_of_a_folder_are_replaced_together_at_the_end(tmp_path):
    (tmp_path / "a.txt").write_text("old")
    with writing_into(tmp_path) as new:
        new("a.txt").write_text("new")
        new("b.txt").write_text("new")
        assert (tmp_path / "a.txt").read_text() == "old"
        assert not (tmp_path / "b.txt").exists()
    assert (tmp_path / "a.txt").read_text() == "new"
    assert names(tmp_path) == ["a.txt", "b.txt"]


def test_an_error_leaves_the_earlier_files_and_nothing_else(tmp_path):
    (tmp_path / "a.txt").write_text("old")

    def fail():
        with writing_into(tmp_path) as new:
            new("a.txt").write_text("half")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert (tmp_path / "a.txt").read_text() == "old"
    assert names(tmp_path) == ["a.txt"]


def test_a_link_stays_one_and_the_file_behind_it_is_replaced(tmp_path):
    (tmp_path / "real.txt").write_text("old")
    os.symlink("real.txt", tmp_path / "link.txt")
    with writing_into(tmp_path) as new:
        new("link.txt").write_text("new")
    assert (tmp_path / "link.txt").is_symlink()
    assert (tmp_path / "real.txt").read_text() == "new"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no such device here")
def test_a_full_disk_is_told_with_what_helps(tmp_path):
    os.symlink("/dev/full", tmp_path / "full.txt")
    with pytest.raises(OutputError, match="free some space"), writing_into(tmp_path) as new:
        new("full.txt").write_text("more than fits")
    assert Path("/dev/full").is_char_device()


def test_a_growing_file_has_its_own_name_where_nothing_stands_there(tmp_path):
    growing = GrowingFile(tmp_path / "a.csv")
    growing.path.write_text("1")
    assert names(tmp_path) == ["a.csv"]
    growing.finish()
    assert (tmp_path / "a.csv").read_text() == "1"


def test_a_growing_file_leaves_an_earlier_one_until_it_is_whole(tmp_path):
    (tmp_path / "a.csv").write_text("old")
    (tmp_path / "a.part.csv").write_text("left by a kill")
    growing = GrowingFile(tmp_path / "a.csv")
    assert names(tmp_path) == ["a.csv"]
    growing.path.write_text("new")
    assert (tmp_path / "a.csv").read_text() == "old"
    growing.finish()
    assert names(tmp_path) == ["a.csv"]
    assert (tmp_path / "a.csv").read_text() == "new"


def test_where_nothing_grew_the_earlier_file_goes(tmp_path):
    (tmp_path / "a.csv").write_text("old")
    GrowingFile(tmp_path / "a.csv").finish()
    assert names(tmp_path) == []
