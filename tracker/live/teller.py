"""Prints one line whenever a hand goes up or a call changes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tracker.containers import CallState, CameraImage, FrameResult


class Teller:
    """A watcher that says what changes.

    Args:
        say: Takes each line.

    Attributes:
        frames: How many images were processed.
    """

    def __init__(self, say: Callable[[str], None]) -> None:
        self._say = say
        self.frames = 0
        self._before: dict[int, tuple[bool, CallState]] = {}

    def watch(self, image: CameraImage, result: FrameResult, busy_s: float) -> None:
        """Take in one frame."""
        self.frames += 1
        now = {caller.id: (caller.is_up, caller.state) for caller in result.waiting_list.callers}
        for caller in result.waiting_list.callers:
            was_up, state = self._before.get(caller.id, (False, CallState.WAITING))
            if caller.is_up and not was_up:
                x, y = np.round(caller.xy_m, 1) + 0.0  # no -0.0
                self._say(f"#{caller.id} raises a hand at x {x:.1f} m, y {y:.1f} m")
            if caller.state is not state:
                self._say(f"#{caller.id} {caller.state.value.replace('_', ' ')}")
        self._before = now
