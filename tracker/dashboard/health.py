"""How are the inputs doing? In words, from the last few seconds of frames."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from typing import Any

from tracker.containers import FrameResult
from tracker.notes import NoteKind

_REACH_S = 5.0


class Health:
    """Counts frames, poses, scans and notes.

    Args:
        now_s: A clock that never jumps.
    """

    def __init__(self, now_s: Callable[[], float] = time.monotonic) -> None:
        self._now_s = now_s
        self._frames: deque[tuple[float, FrameResult, float]] = deque()

    def add(self, result: FrameResult, busy_s: float) -> None:
        """Take in one frame."""
        self._frames.append((self._now_s(), result, busy_s))
        self._forget()

    def lines(self) -> list[dict[str, Any]]:
        """Each input's name, `ok` or `warn`, and words."""
        self._forget()
        frames = list(self._frames)
        if not frames:
            return [_line("camera", False, f"no picture for {_REACH_S:g} s")]
        rate_hz = len(frames) / _REACH_S if len(frames) > 1 else 0.0
        busy_ms = 1000 * sum(busy for *_, busy in frames) / len(frames)
        count = len(frames)
        scans = sum(result.scan is not None for _, result, _ in frames)
        poses = sum(result.sensor_pose is not None for _, result, _ in frames)
        words = f"{rate_hz:.1f} pictures a second, {busy_ms:.0f} ms each"
        lines = [_line("camera", True, words)]
        if scans:
            words = f"used by {scans} of the last {count} pictures"
            lines.append(_line("laser", scans >= 0.9 * count, words))
        else:
            lines.append(_line("laser", False, "no scan is used: directions without distances"))
        missing = f"no position in {count - poses} pictures"
        where = "the position of camera and robot is known" if poses == count else missing
        lines.append(_line("transforms", poses == count, where))
        notes = {note.kind: note.text for _, result, _ in frames for note in result.notes}
        told = (NoteKind.NO_SCAN, NoteKind.NO_POSE)
        lines += [_line(kind.value, False, text) for kind, text in notes.items()
                  if kind not in told]  # fmt: skip
        return lines

    def _forget(self) -> None:
        oldest_s = self._now_s() - _REACH_S
        while self._frames and self._frames[0][0] < oldest_s:
            self._frames.popleft()


def _line(name: str, is_well: bool, words: str) -> dict[str, Any]:
    return {"name": name, "level": "ok" if is_well else "warn", "words": words}
