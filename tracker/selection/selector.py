"""Who is served? One of the customers whose hand is up, and the same one while it stays up."""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import FloatArray, Tracks


class Selector:
    """Remembers the chosen customer.

    Args:
        config: `selection` and `selection_hold_s`.
    """

    def __init__(self, config: Config) -> None:
        self.config = config
        self._chosen_id: int | None = None
        self._last_raised_ns = 0
        self._released: set[int] = set()

    def choose(self, tracks: Tracks, stamp_ns: int, robot_xy_m: FloatArray) -> int | None:
        """The customer who is served after this frame.

        Args:
            tracks: All customers, with their raised state.
            stamp_ns: This frame's.
            robot_xy_m: Shape (2,): where the robot is, for `selection: nearest`.

        Returns:
            Their id, or None where no hand is up.
        """
        if self._keeps(tracks, stamp_ns):
            return self._chosen_id
        calling = tracks.raised
        if self._released:  # they are served again once the hand has been down and up
            self._released &= set(tracks.id[calling].tolist())
            calling = calling & ~np.isin(tracks.id, list(self._released))
        rows = np.flatnonzero(calling)
        if len(rows) == 0:
            self._chosen_id = None
            return None
        if self.config.selection == "nearest":
            order = np.linalg.norm(tracks.mean[rows, :2] - robot_xy_m, axis=-1)
        elif self.config.selection == "first":
            order = tracks.raised_since_ns[rows]
        else:
            order = -tracks.raised_since_ns[rows]
        self._chosen_id = int(tracks.id[rows[np.argmin(order)]])
        self._last_raised_ns = stamp_ns
        return self._chosen_id

    def release(self) -> int | None:
        """Let the chosen customer go; the next frame chooses among the others.

        Returns:
            Who was let go, or None.
        """
        released, self._chosen_id = self._chosen_id, None
        if released is not None:
            self._released.add(released)
        return released

    def reset(self) -> None:
        """Forget everybody."""
        self._chosen_id = None
        self._released.clear()

    def _keeps(self, tracks: Tracks, stamp_ns: int) -> bool:
        if self._chosen_id is None:
            return False
        ids = tracks.id.tolist()
        if self._chosen_id not in ids:
            return False
        if tracks.raised[ids.index(self._chosen_id)]:
            self._last_raised_ns = stamp_ns
            return True
        held_ns = stamp_ns - self._last_raised_ns
        return held_ns <= self.config.selection_hold_s * 1e9 and self.config.selection_hold_s > 0.0
