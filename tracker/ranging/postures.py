"""Which customers sit? It is remembered while the hand is down."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray, Hands, Tracks

#: Whoever moves faster has stood up (guess).
_WALKS_MPS = 0.4


class Postures:
    """Remembers for each customer whether they sit."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Forget everybody."""
        self._known: dict[int, tuple[FloatArray, float]] = {}

    def learn(self, tracks: Tracks, hands: Hands) -> None:
        """Take note of one frame.

        Args:
            tracks: The customers after it.
            hands: Of its image.
        """
        before, self._known = self._known, {}
        walks = np.hypot(tracks.mean[:, 2], tracks.mean[:, 3]) > _WALKS_MPS
        for row in np.flatnonzero(~walks).tolist():
            number, hand = int(tracks.id[row]), int(tracks.hand[row])
            seated = float(hands.seated[hand]) if hand >= 0 else np.nan
            if np.isnan(seated):
                seated = before.get(number, (None, np.nan))[1]
            if not np.isnan(seated):
                self._known[number] = tracks.mean[row, :2], seated

    def at(self, xy_m: FloatArray, reach_m: float) -> FloatArray:
        """Whether who stands there sits, shape (C,), in [0, 1]; NaN where nobody knows.

        Args:
            xy_m: Shape (C, 2), in the fixed frame.
            reach_m: A customer is no farther away than this.
        """
        if not self._known or len(xy_m) == 0:
            return np.full(len(xy_m), np.nan)
        places, seated = zip(*self._known.values(), strict=True)
        apart_m = np.linalg.norm(xy_m[:, None] - np.array(places), axis=-1)
        nearest = apart_m.argmin(axis=1)
        is_near = apart_m.min(axis=1) <= reach_m
        return np.where(is_near, np.array(seated)[nearest], np.nan)
