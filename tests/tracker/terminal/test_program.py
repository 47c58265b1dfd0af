"""How programs end, tried on processes of their own."""

import os
import signal
import subprocess
import sys
import time

import pytest

from tracker.wording import one_line

FULL = "/dev/full"
STOPPED = "raised-hand: stopped; the files written so far can be read."


def run(*words, **options):
    command = [sys.executable, "-m", "tracker.cli", *words]
    return subprocess.run(command, stderr=subprocess.PIPE, **options)


def last_line(ended):
    error = ended.stderr.decode()
    assert "Traceback" not in error
    assert "Exception ignored" not in error
    return error.splitlines()[-1]


@pytest.mark.skipif(not os.path.exists(FULL), reason="there is no /dev/full here")
@pytest.mark.parametrize("words", [["models", "list"], ["--help"], ["monte-carlo"]], ids=" ".join)
def test_an_output_that_is_full_is_one_line_and_status_1(words):
    with open(FULL, "w") as full:
        ended = run(*words, stdout=full)
    assert ended.returncode == 1
    assert "No space left on device" in last_line(ended)


def test_letters_that_the_output_does_not_have_are_written_out():
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    ended = run("demo", "cafÃ©", env=environment)
    assert ended.returncode == 2
    assert "caf\\xc3\\xa9" in last_line(ended)
    assert run("models", "list", env=environment, stdout=subprocess.DEVNULL).returncode == 0


@pytest.mark.parametrize(
    "words",
    [
        ["replay", "{}"],
        ["replay", "x.mcap", "--config", "{}"],
        ["simulate", "lonely", "--out", "{}"],
        ["monte-carlo", "outliers", "--report", "{}"],
        ["play", "{}"],
    ],
    ids=" ".join,
)
def test_names_that_cannot_be_are_found_before_the_work(words, tmp_path):
    for name, reason in ((b"caf\xe9.mcap", "is not UTF-8 text"), (b"x" * 4500, "name too long")):
        ended = run(*(word.encode().replace(b"{}", name) for word in words), cwd=tmp_path)
        assert ended.returncode == 2
        line = last_line(ended)
        assert reason in line
        assert len(line) < 400
        assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("delay_s", [0.2, 0.5, 0.8])
def test_ctrl_c_is_one_line_from_the_first_import_on(delay_s):
    command = [sys.executable, "-m", "tracker.cli", "monte-carlo", "people", "-n", "1000"]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, start_new_session=True)
    time.sleep(delay_s)
    os.killpg(process.pid, signal.SIGINT)
    _, error = process.communicate(timeout=60)
    # What a shell shows as 130, too: Python ends by the signal if it came in code from a string.
    assert process.returncode in (130, -signal.SIGINT)
    assert "Traceback" not in error.decode()
    assert error.decode().splitlines()[-1] == STOPPED


@pytest.mark.skipif(sys.platform == "win32", reason="there is no such limit")
def test_too_little_memory_is_one_line_instead_of_a_crash():
    import resource

    limit = (500_000_000, resource.RLIM_INFINITY)
    ended = run("monte-carlo", preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, limit))
    assert ended.returncode == 2
    assert "limited to 0.50 GB (ulimit -v)" in last_line(ended)


def test_a_text_for_a_terminal_has_no_control_characters_and_no_endless_words():
    assert one_line("a\x1b[2Jb\nc") == "a\\x1b[2Jb\\nc"
    assert one_line(f"see {'x' * 5000} there") == f"see {'x' * 200}... there"
