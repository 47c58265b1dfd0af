"""`raised-hand replay --serve` as a person meets it: a page that stays until Ctrl-C."""

import json
import os
import re
import signal
import subprocess
import sys
import time
import urllib.request
from pathlib import Path
from urllib.parse import urlsplit

import pytest

pytest.importorskip("starlette", reason="the extra live is not installed")
pytest.importorskip("uvicorn", reason="the extra live is not installed")
pytest.importorskip("websockets", reason="the extra live is not installed")

from websockets.sync.client import connect

ROOT = Path(__file__).parents[3]


@pytest.fixture
def serving(write_bag, tmp_path, model_store):
    """A replay that serves, and its complaints line by line."""
    bag = write_bag(tmp_path / "in.mcap")
    words = ["-m", "tracker.cli", "replay", str(bag), "-o", str(tmp_path / "out"), "--serve"]
    process = subprocess.Popen(
        [sys.executable, "-u", *words, "--port", "0"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(ROOT), "COLUMNS": "300"},
    )  # fmt: skip
    yield process
    process.kill()
    process.communicate()


def wait_for_line(process, pattern):
    end = time.monotonic() + 300.0
    for line in process.stderr:
        if found := re.search(pattern, line):
            return found
        assert time.monotonic() < end
    raise AssertionError("it ended before it said so")


@pytest.mark.model
@pytest.mark.slow
def test_the_page_of_a_replay_stays_with_its_last_frame_until_ctrl_c(serving, tmp_path):
    url = wait_for_line(serving, r"the page: (http://127\.0\.0\.1:\d+/)").group(1)
    wait_for_line(serving, "the page stays open until Ctrl-C")
    assert urllib.request.urlopen(url, timeout=10).status == 200
    place = urlsplit(url).netloc
    with connect(f"ws://{place}/frames", origin=f"http://{place}") as socket:
        hello = json.loads(socket.recv(10))
        assert hello["title"].endswith("in.mcap")
        assert not hello["can_steer"], "what was recorded cannot be changed"
        socket.send(json.dumps("next"))
        state, jpeg = json.loads(socket.recv(10)), socket.recv(10)
        assert (state["frame"], jpeg[:2]) == (20, b"\xff\xd8")
    serving.send_signal(signal.SIGINT)
    output, complaints = serving.communicate(timeout=30)
    assert serving.returncode == 0, complaints
    assert "wrote" in output
    assert (tmp_path / "out/summary.json").exists()
