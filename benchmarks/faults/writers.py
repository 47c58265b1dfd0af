"""Writers that are killed, and disks that are full: what stays must read as far as it goes."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import cv2

from tracker.errors import TrackerError
from tracker.recording import open_recording

_REPLAY = """
import sys
from pathlib import Path
from tracker.containers import Hands
from tracker.errors import TrackerError
from tracker.replay import replay

class Nobody:
    work = None
    def find(self, image, hints): return Hands.none()
    def reset(self): pass
    def configure(self, config): pass

try:
    replay(sys.argv[1], sys.argv[2], detector=Nobody())
except TrackerError as error:
    sys.exit(str(error))
"""


def replay_words(source: Path, out: Path) -> list[str]:
    """A replay by a detector that finds nobody, so that no model is needed."""
    return [sys.executable, "-c", _REPLAY, str(source), str(out)]


def simulate_words(out: Path) -> list[str]:
    """A simulation of a scene that comes along."""
    return [sys.executable, "-m", "tracker.cli", "simulate", "lonely", "-o", str(out), "--force"]


def kill_when_grown(words: list[str], growing: Path, size: int) -> bool:
    """Start a writer, and kill it when a file has grown so far; whether it lived until then."""
    with subprocess.Popen(
        words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
    ) as writer:
        until_s = time.monotonic() + 60.0
        while time.monotonic() < until_s and writer.poll() is None:
            if growing.exists() and growing.stat().st_size >= size:
                break
            time.sleep(0.01)
        is_alive = writer.poll() is None
        if is_alive:
            os.kill(writer.pid, signal.SIGKILL)
    return is_alive


def complaints_about(folder: Path, suffix: str = "") -> list[str]:
    """What is wrong with the files of a killed replay; `suffix` as in output.part.mcap."""
    found = []
    try:
        with open_recording(folder / f"output{suffix}.mcap") as recording:
            if not any(info.count for info in recording.topics.values()):
                found.append("the recording holds nothing")
    except TrackerError as error:
        found.append(str(error))
    table = folder / f"tracks{suffix}.csv"
    if not table.exists() or not table.read_text().endswith("\n"):
        found.append("the table ends in the middle of a line")
    video = folder / f"debug{suffix}.mp4"
    if not cv2.VideoCapture(str(video)).read()[0]:
        found.append("the video does not play")
    return found


@contextmanager
def small_disk(place: Path, megabytes: int) -> Iterator[Path | None]:
    """A disk of that size; None where none can be mounted."""
    place.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", f"size={megabytes}m", "faults", str(place)]
    try:
        is_there = subprocess.run(mount, capture_output=True, check=False).returncode == 0
    except OSError:
        is_there = False
    try:
        yield place if is_there else None
    finally:
        if is_there:
            subprocess.run(["umount", str(place)], check=False)
