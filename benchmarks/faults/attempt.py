"""One attempt in a process of its own: what it read, what it said, and what that cost."""

from __future__ import annotations

import json
import os
import resource
import signal
import sys
import tempfile
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from tracker.errors import TrackerError
from tracker.messages.picture_size import MAX_PIXELS
from tracker.recording import open_recording
from tracker.recording.sources import RawMessage, Reading

LIMIT_BYTES = 1_500_000_000
_TIME_S = 60


class Outcome(NamedTuple):
    """What came of it.

    Attributes:
        keys: Topic and log time of each message that was read.
        said: The error that was told; empty for none.
        crash: A traceback, or how the process died; empty for neither.
        peak_bytes: The most memory that the process held.
    """

    keys: list[tuple[str, int]]
    said: str
    crash: str
    peak_bytes: int


def attempt(work: Callable[[], dict[str, Any]]) -> Outcome:
    """Run some work in a forked process, limited in memory and time."""
    with tempfile.TemporaryFile("w+") as told:
        child = os.fork()
        if child == 0:
            _limited(work, told.fileno())
        _, status, usage = os.wait4(child, 0)
        told.seek(0)
        text = told.read()
    peak = usage.ru_maxrss * 1024
    if not text:
        return Outcome([], "", f"died of signal {os.WTERMSIG(status)}", peak)
    outcome = json.loads(text)
    keys = [(topic, log_ns) for topic, log_ns in outcome.get("keys", [])]
    return Outcome(keys, outcome.get("said", ""), outcome.get("crash", ""), peak)


def read(path: Path) -> dict[str, Any]:
    """Everything in a recording, message by message and again as `events` has it."""
    keys, said = [], ""
    try:
        with open_recording(path, with_truth=True) as recording:
            try:
                for message in recording._source.messages(set(recording.topics)):
                    if _is_understood(message):
                        keys.append((message.topic, message.log_ns))
            except TrackerError as error:
                said = str(error)
            try:
                for _ in recording.events():
                    pass
            except TrackerError as error:
                said = said or str(error)
            skipped = " ".join(recording.skipped_lines())
            said = said or skipped
    except TrackerError as error:
        said = str(error)
    return {"keys": keys, "said": said}


def _is_understood(message: RawMessage) -> bool:
    try:
        message.read(Reading(MAX_PIXELS))
    except TrackerError:
        return False
    return True


def _limited(work: Callable[[], dict[str, Any]], told: int) -> None:
    resource.setrlimit(resource.RLIMIT_AS, (4 * LIMIT_BYTES, 4 * LIMIT_BYTES))
    signal.alarm(_TIME_S)
    try:
        outcome = work()
    except BaseException:  # noqa: BLE001, whatever it is, it is the finding
        outcome = {"crash": traceback.format_exc()}
    os.write(told, json.dumps(outcome).encode())
    sys.stdout.flush()
    os._exit(0)
