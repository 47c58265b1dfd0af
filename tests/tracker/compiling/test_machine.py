"""Machine code comes in the background, and is kept."""

import logging
import subprocess
import sys
import tempfile
import threading

import pytest

from tracker.compiling import files
from tracker.compiling.machine import Machine


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Where code would be kept: an empty place."""
    monkeypatch.setattr(files, "folder", lambda: tmp_path / "code")
    return tmp_path / "code"


@pytest.fixture
def wait_for_the_compiler():
    """Waits until whatever was begun in the background since the test began is done."""
    others = threading.enumerate()

    def wait():
        for thread in threading.enumerate():
            if thread not in others:
                thread.join()

    return wait


def test_nothing_waits_for_the_compiler_and_then_the_code_is_there(
    small, folder, wait_for_the_compiler
):
    machine = Machine(small().build)
    machine.start()
    assert machine.code is None
    machine.start()  # once is enough
    wait_for_the_compiler()
    assert machine.code(3.0) == 6.0
    assert files.are_in(folder)


def test_code_that_is_kept_is_there_at_once(small, folder):
    module = small()
    module.build(folder)
    machine = Machine(module.build)
    machine.start()
    assert machine.code(3.0) == 6.0
    assert sum(machine.code.stats.cache_hits.values()) == 1


@pytest.mark.parametrize("suffix", [".nbi", ".nbc"])
def test_code_that_was_cut_off_is_compiled_again_in_the_background(
    small, folder, suffix, wait_for_the_compiler
):
    module = small()
    module.build(folder)
    for path in folder.glob(f"*{suffix}"):
        path.write_bytes(path.read_bytes()[:20])
    machine = Machine(module.build)
    machine.start()
    assert machine.code is None
    wait_for_the_compiler()
    assert machine.code(3.0) == 6.0
    assert sum(machine.code.stats.cache_hits.values()) == 1


def test_who_wants_to_wait_is_told_once_that_the_compiler_runs(small, folder):
    said, build = [], small().build
    for _ in range(2):
        machine = Machine(build)
        machine.finish(said.append)
        assert machine.code(3.0) == 6.0
        machine.finish(said.append)
    (sentence,) = said
    assert sentence.startswith("Compiling the tracker, once on this machine")


def test_where_nothing_can_be_kept_it_is_said_and_works_all_the_same(
    small, folder, caplog, wait_for_the_compiler
):
    folder.write_text("a file where the folder should be")
    machine, said = Machine(small().build), []
    machine.start()
    wait_for_the_compiler()
    assert machine.code(3.0) == 6.0
    assert str(folder) in caplog.text
    assert "NUMBA_CACHE_DIR" in caplog.text

    machine = Machine(machine._build)
    machine.finish(said.append)
    assert machine.code(3.0) == 6.0
    assert str(folder) in said[-1]
    assert "NUMBA_CACHE_DIR" in said[-1]


def test_who_has_no_home_has_no_folder_and_code_nevertheless(small, monkeypatch):
    monkeypatch.setattr(files, "folder", lambda: None)
    machine, said = Machine(small().build), []
    machine.finish(said.append)
    assert machine.code(3.0) == 6.0
    assert "no home" in said[-1]


def test_a_compiler_that_fails_is_said_and_python_goes_on(
    small, folder, caplog, capfd, wait_for_the_compiler
):
    machine = Machine(small().fail)
    machine.start()
    wait_for_the_compiler()
    assert machine.code is None
    assert "The compiler failed" in caplog.text
    assert "no compiler today" in capfd.readouterr().err


def test_a_numba_that_cannot_be_loaded_is_said_and_python_goes_on(folder, caplog):
    def build(folder, may_compile):
        raise ImportError("Numba needs NumPy 2.2 or less")

    folder.mkdir()
    (folder / "function.nbi").touch()
    machine, said = Machine(build), []
    machine.start()
    machine.finish(said.append)
    assert machine.code is None
    assert "Numba needs NumPy 2.2 or less" in caplog.text
    assert "Numba needs NumPy 2.2 or less" in said[-1]


def test_where_no_process_can_be_started_python_goes_on(
    small, folder, caplog, monkeypatch, wait_for_the_compiler
):
    monkeypatch.setattr(sys, "executable", "/nowhere/python")
    machine = Machine(small().build)
    machine.start()
    wait_for_the_compiler()
    assert machine.code is None
    assert "The compiler cannot be started" in caplog.text


def test_without_a_place_for_passing_files_what_is_kept_is_compiled_all_the_same(
    small, folder, monkeypatch, wait_for_the_compiler
):
    monkeypatch.setattr(tempfile, "tempdir", "/nowhere")
    machine = Machine(small().build)
    machine.start()
    wait_for_the_compiler()
    assert machine.code(3.0) == 6.0


def test_where_nothing_can_be_written_at_all_python_goes_on(
    small, monkeypatch, caplog, wait_for_the_compiler
):
    monkeypatch.setattr(files, "folder", lambda: None)
    monkeypatch.setattr(tempfile, "tempdir", "/nowhere")
    machine = Machine(small().build)
    machine.start()
    wait_for_the_compiler()
    assert machine.code is None
    assert "The compiler cannot be started" in caplog.text


def program(module, folder, build, then=""):
    """Starts the compiler of a function of that module; and what the program does then."""
    return (
        "import os, signal, time\n"
        "from pathlib import Path\n"
        "from tracker.compiling import files\n"
        f"from {module.__name__} import {build} as build\n"
        "from tracker.compiling.machine import Machine\n"
        f"folder = Path({str(folder)!r})\n"
        "files.folder = lambda: folder\n"
        "machine = Machine(build)\n"
        "machine.start()\n" + then
    )


def ends(source):
    """The exit status of a program, and what it says."""
    ended = subprocess.run(
        [sys.executable, "-c", source], capture_output=True, text=True, start_new_session=True
    )
    return ended.returncode, ended.stderr


def test_a_program_that_ends_does_not_wait_for_its_compiler(small, folder):
    assert ends(program(small(), folder, "build")) == (0, "")
    assert not files.are_in(folder)


def test_ctrl_c_is_the_programs_and_the_compiler_says_nothing_of_it(small, folder):
    interrupted = (
        "while not list(folder.glob('*.begun')):\n"
        "    time.sleep(0.01)\n"
        "try:\n"
        "    os.killpg(0, signal.SIGINT)\n"
        "    time.sleep(60)\n"
        "except KeyboardInterrupt:\n"
        "    time.sleep(0.2)\n"
    )
    assert ends(program(small(), folder, "linger", interrupted)) == (0, "")


def test_a_process_that_is_forked_off_meanwhile_gets_the_code_as_well(small, folder):
    forked = (
        "child = os.fork()\n"
        "if child == 0:\n"
        "    machine.finish(lambda sentence: None)\n"
        "    os._exit(0 if machine.code and machine.code(3.0) == 6.0 else 1)\n"
        "assert os.waitpid(child, 0)[1] == 0\n"
    )
    assert ends(program(small(), folder, "build", forked)) == (0, "")


def test_programs_that_start_together_compile_one_after_the_other(small, folder):
    source = program(small(), folder, "linger", "machine.finish(print)\n")
    both = [subprocess.Popen([sys.executable, "-c", source]) for _ in range(2)]
    assert [each.wait() for each in both] == [0, 0]
    assert (folder / "diary").read_text() == "begin end begin end "


def test_in_the_background_a_word_is_said_when_it_begins_and_when_it_is_done(
    small, folder, caplog, wait_for_the_compiler
):
    caplog.set_level(logging.INFO)
    Machine(small().build).start()
    wait_for_the_compiler()
    assert [record.levelname for record in caplog.records] == ["INFO", "INFO"]
