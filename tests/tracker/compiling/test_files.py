"""Where machine code is kept."""

import os
import shutil
from pathlib import Path

import pytest

pytest.importorskip("numba", reason="numba is not installed")

from tracker.compiling import files

TRACKER = Path(files.__file__).parents[1]


@pytest.fixture
def name(monkeypatch):
    """Says the folder's name as a new process would."""

    def now():
        files.folder.cache_clear()
        return files.folder().name

    yield now
    monkeypatch.undo()
    files.folder.cache_clear()


@pytest.fixture
def copied(tmp_path, monkeypatch):
    """The rooms of the sources, at another place."""
    for room in ("compiling", "containers", "tracking"):
        shutil.copytree(TRACKER / room, tmp_path / room)
    monkeypatch.setattr(files, "__file__", str(tmp_path / "compiling/files.py"))
    return tmp_path


@pytest.mark.parametrize("source", ["tracking/sensing/view.py", "containers/sensor_kind.py"])
def test_a_source_that_changes_names_another_folder(name, copied, source):
    before = name()
    with (copied / source).open("a") as file:
        file.write("# changed\n")
    assert name() != before


def test_an_installation_that_changes_nothing_loses_nothing(name, copied):
    before = name()
    for path in copied.rglob("*.py"):
        os.utime(path, (1, 1))
    assert name() == before


def test_another_version_or_processor_names_another_folder(name, monkeypatch):
    import llvmlite.binding

    names = {name()}
    monkeypatch.setattr(files, "version", lambda _: "0.0")
    names.add(name())
    monkeypatch.setattr(llvmlite.binding, "get_host_cpu_name", lambda: "abacus")
    names.add(name())
    assert len(names) == 3


def test_the_folder_is_where_numba_is_told_to_keep_its_own(name, monkeypatch, tmp_path):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    name()
    assert files.folder().parent == tmp_path


def test_who_has_no_home_has_no_folder(name, monkeypatch):
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.setattr(files, "user_cache", lambda: None)
    files.folder.cache_clear()
    assert files.folder() is None
    assert "no home" in files.trouble_with(None)


def test_a_place_that_can_be_written_is_made_and_is_no_trouble(tmp_path):
    assert files.trouble_with(tmp_path / "a" / "b") == ""
    assert (tmp_path / "a" / "b").is_dir()


def test_a_place_that_cannot_be_is_named(tmp_path):
    (tmp_path / "file").touch()
    trouble = files.trouble_with(tmp_path / "file" / "code")
    assert str(tmp_path / "file" / "code") in trouble


def test_code_is_there_once_its_index_is(tmp_path):
    assert not files.are_in(tmp_path)
    assert not files.are_in(tmp_path / "nowhere")
    (tmp_path / "function.nbi").touch()
    assert files.are_in(tmp_path)
