"""The gesture of each customer; it is kept for a moment after the hand was last seen."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracker.containers import Hands, Tracks
from tracker.gesture import Gesture

#: A hand that is lost in a few images still says what it said (guess).
_HOLD_NS = 500_000_000


class CustomerGestures:
    """Remembers what customers said last."""

    def __init__(self) -> None:
        self._said: dict[int, tuple[int, int]] = {}

    def add_to(self, tracks: Tracks, hands: Hands) -> Tracks:
        """The same tracks with `gesture`.

        Args:
            tracks: After an image; `hand` leads to rows of `hands`.
            hands: Of that image, with `gesture`.
        """
        gesture = np.full(len(tracks), int(Gesture.NONE))
        seen = tracks.hand >= 0
        gesture[seen] = hands.gesture[tracks.hand[seen]]
        said = {}
        for row, track_id in enumerate(tracks.id.tolist()):
            if seen[row]:
                said[track_id] = (int(gesture[row]), tracks.stamp_ns)
                continue
            before, at_ns = self._said.get(track_id, (int(Gesture.NONE), -1))
            if at_ns >= 0 and 0 <= tracks.stamp_ns - at_ns <= _HOLD_NS:
                gesture[row], said[track_id] = before, (before, at_ns)
        self._said = said
        return replace(tracks, gesture=gesture)

    def reset(self) -> None:
        """Forget everybody."""
        self._said = {}


class GestureNews:
    """Tells what confirmed customers say, whenever that changes: `3 wave`, later `3 none`."""

    def __init__(self) -> None:
        self._said: dict[int, Gesture] = {}

    def after(self, tracks: Tracks) -> list[str]:
        """What is new after an image; who is gone says `none`."""
        confirmed = tracks[tracks.confirmed]
        codes = zip(confirmed.id.tolist(), confirmed.gesture.tolist(), strict=True)
        said = {track_id: Gesture(code) for track_id, code in codes if code != Gesture.NONE}
        before, self._said = self._said, said
        news = {track_id: Gesture.NONE for track_id in before if track_id not in said}
        news |= {key: gesture for key, gesture in said.items() if before.get(key) != gesture}
        return [f"{track_id} {gesture.word}" for track_id, gesture in sorted(news.items())]
