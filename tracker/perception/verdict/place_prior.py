"""Places of the picture that always seem to call, such as posters; they need more evidence.

A poster of a raised hand, a coat on a hook or a lamp calls for hours and never moves; people move
their hand within seconds, and take it down within a minute.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.containers import FloatArray

#: A call that has stood still for so long begins to raise the bar, and has raised it all the way
#: after so long again, s (guesses: a waiter who does not come is called for half a minute).
STILL_S, RAISING_S = 20.0, 20.0
#: The most that the bar rises, in log-odds: more than any belief (`LOG_ODDS_MAX`).
BAR_MAX = 6.0
#: What nobody shows any more is forgotten with this time constant, s.
FORGET_S = 600.0
#: Farther than this, in sizes of the hand, is another place, or a hand that moved.
_SAME_PLACE, _STILL = 0.5, 0.25


@dataclass(slots=True)
class _Place:
    """Where something seems to call.

    Attributes:
        wrist_px: Shape (2,), of the first image; a hand that leaves it has moved.
        size_px: Of the hand.
        since_ns: Since when it has stood there.
        seen_ns: When it was last there.
        bar: What is asked for in addition, log-odds.
    """

    wrist_px: FloatArray
    size_px: float
    since_ns: int
    seen_ns: int
    bar: float = 0.0


class PlacePrior:
    """Learns from image to image; forgets what is gone."""

    def __init__(self) -> None:
        self._places: list[_Place] = []

    def bars(self, stamp_ns: int, wrist_px: FloatArray, size_px: FloatArray) -> FloatArray:
        """What hands with wrists (H, 2) and sizes (H,) must bring in addition, log-odds, (H,)."""
        return np.array(
            [
                max((self._faded(item, stamp_ns) for item in self._near(wrist, size)), default=0.0)
                for wrist, size in zip(wrist_px, size_px, strict=True)
            ]
        )

    def learn(self, stamp_ns: int, wrist_px: FloatArray, size_px: FloatArray) -> None:
        """Take in the hands, likewise, of an image that would call if no bar were raised."""
        for wrist, size in zip(wrist_px, size_px, strict=True):
            near = self._near(wrist, size)
            if not near:
                self._places.append(_Place(wrist, float(size), stamp_ns, stamp_ns))
                continue
            place = near[0]
            place.bar = self._faded(place, stamp_ns)
            moved = float(np.linalg.norm(wrist - place.wrist_px)) > _STILL * place.size_px
            if moved or stamp_ns - place.seen_ns > STILL_S * 1e9:
                place.wrist_px, place.size_px, place.since_ns = wrist, float(size), stamp_ns
            stood_s = (stamp_ns - place.since_ns) / 1e9
            grown = BAR_MAX * float(np.clip((stood_s - STILL_S) / RAISING_S, 0.0, 1.0))
            place.bar, place.seen_ns = max(place.bar, grown), stamp_ns
        self._places = [
            item
            for item in self._places
            if stamp_ns - item.seen_ns <= STILL_S * 1e9 or self._faded(item, stamp_ns) > 0.5
        ]

    @property
    def highest(self) -> float:
        """The highest bar at any place, in log-odds; 0 where nothing was learned."""
        return max((item.bar for item in self._places), default=0.0)

    def reset(self) -> None:
        """Forget all places."""
        self._places = []

    def _near(self, wrist_px: FloatArray, size_px: float) -> list[_Place]:
        """Places of this hand, the nearest first."""
        apart = [float(np.linalg.norm(item.wrist_px - wrist_px)) for item in self._places]
        order = np.argsort(apart, kind="stable")
        return [
            self._places[row]
            for row in order
            if apart[row] <= _SAME_PLACE * max(size_px, self._places[row].size_px)
        ]

    @staticmethod
    def _faded(place: _Place, stamp_ns: int) -> float:
        return place.bar * float(np.exp(-max(stamp_ns - place.seen_ns, 0) / (FORGET_S * 1e9)))
