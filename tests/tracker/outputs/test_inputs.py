import os
from pathlib import Path

import pytest

from tracker.errors import ConfigError
from tracker.outputs import check_inputs_stay


@pytest.fixture
def places(tmp_path, monkeypatch):
    """A file `drive`, a folder `photos` with one, links to both, and a folder of its own."""
    monkeypatch.chdir(tmp_path)
    Path("drive").write_text("drive")
    Path("photos/deep").mkdir(parents=True)
    Path("photos/a.png").write_text("a")
    Path("photos/deep/b.png").write_text("b")
    Path("own").mkdir()
    os.symlink("drive", "link")
    os.symlink("photos", "album")
    os.link("drive", "own/twin")
    os.link("photos/deep/b.png", "own/twin_of_b")
    return tmp_path


@pytest.mark.parametrize(
    ("source", "output"),
    [
        ("drive", "drive"),
        ("drive", "link"),
        ("link", "drive"),
        ("drive", "own/twin"),
        ("drive", "own/../photos/../drive"),
        ("photos", "photos/new.png"),
        ("photos", "photos/a.png"),
        ("photos", "photos/deep/b.png"),
        ("photos", "album/new.png"),
        ("album", "photos/new.png"),
        ("photos", "own/../photos/new.png"),
        ("photos", "own/twin_of_b"),
    ],
)
def test_an_output_that_is_an_input_under_any_name_is_refused(places, source, output):
    with pytest.raises(ConfigError, match="choose another"):
        check_inputs_stay([Path(source)], [Path("own/new"), places / output])


def test_what_a_kill_left_is_an_input_too(places):
    Path("own/table.part.csv").write_text("")
    with pytest.raises(ConfigError, match=r"table\.csv: .* would replace the input .*part"):
        check_inputs_stay([Path("own/table.part.csv")], [Path("own/table.csv")])


def test_spellings_count_as_one_where_the_disk_knows_no_capitals(places, monkeypatch):
    same = os.path.samefile
    monkeypatch.setattr(os.path, "samefile", lambda a, b: same(str(a).lower(), str(b).lower()))
    with pytest.raises(ConfigError, match="DRIVE"):
        check_inputs_stay([Path("drive")], [Path("own/../DRIVE")])


def test_two_outputs_at_one_place_are_refused(places):
    with pytest.raises(ConfigError, match="two outputs"):
        check_inputs_stay([], [Path("own/a"), Path("photos/../own/a")])


def test_neighbors_of_an_input_and_new_folders_inside_are_free(places):
    check_inputs_stay([Path("drive"), None], [Path("drive.html"), Path("own/x"), None])
    check_inputs_stay([Path("photos")], [Path("photos/new/x.png"), Path("own/x.png")])
    check_inputs_stay([Path("nowhere")], [Path("nowhere")])
