"""What the page shows of the past: trails, and when whose hand was up and who was served."""

from __future__ import annotations

from collections import deque
from typing import Any

from tracker.containers import FrameResult

#: The timeline reaches back so far, and a trail has so many places.
_REACH_NS, _TRAIL = 120_000_000_000, 80


class Memory:
    """The last two minutes, in little memory."""

    def __init__(self) -> None:
        self._trails: dict[int, deque[tuple[float, float]]] = {}
        self._spans: dict[tuple[int, str], list[list[int]]] = {}
        self._stamp_ns = 0

    def add(self, result: FrameResult) -> None:
        """Take in one frame."""
        if result.stamp_ns < self._stamp_ns:
            self.__init__()  # type: ignore[misc]  # the clock has jumped back
        self._stamp_ns = result.stamp_ns
        confirmed = result.tracks[result.tracks.confirmed]
        for track_id, place in zip(confirmed.id.tolist(), confirmed.mean.tolist(), strict=True):
            trail = self._trails.setdefault(track_id, deque(maxlen=_TRAIL))
            trail.append((round(place[0], 2), round(place[1], 2)))
        for gone in self._trails.keys() - set(confirmed.id.tolist()):
            del self._trails[gone]
        for caller in result.waiting_list.callers:
            self._go_on(caller.id, "up", caller.is_up)
            self._go_on(caller.id, caller.state.value, caller.state.is_open)
        self._forget()

    def trail(self, track_id: int) -> list[tuple[float, float]]:
        """Where somebody has been, oldest first."""
        return list(self._trails.get(track_id, ()))

    def timeline(self) -> list[dict[str, Any]]:
        """For each person and kind the spans, in seconds before now: [from, until]."""
        return [
            {
                "id": person,
                "kind": kind,
                "spans": [
                    [round((self._stamp_ns - one) / 1e9, 1) for one in span] for span in spans
                ],
            }
            for (person, kind), spans in list(self._spans.items())
        ]

    def _go_on(self, person: int, kind: str, is_so: bool) -> None:
        spans = self._spans.setdefault((person, kind), [])
        if not is_so:
            return
        # Frames a second apart belong to one span.
        if spans and self._stamp_ns - spans[-1][1] <= 1_000_000_000:
            spans[-1][1] = self._stamp_ns
        else:
            spans.append([self._stamp_ns, self._stamp_ns])

    def _forget(self) -> None:
        oldest_ns = self._stamp_ns - _REACH_NS
        for key, spans in list(self._spans.items()):
            while spans and spans[0][1] < oldest_ns:
                spans.pop(0)
            if not spans:
                del self._spans[key]
