"""Does this stamp make sense after those before?

One odd stamp is an error, two in a row that agree are a new time: a single broken or reordered
message must not reset everybody's tracks, a recording that loops must.
"""

from __future__ import annotations

from enum import Enum

#: Two odd stamps that follow each other within this agree on the time.
_AGREE_NS = 2_000_000_000


class Step(Enum):
    """How a stamp follows those before."""

    ONWARD = "as it should"
    ODD = "far from the one before; believed if the next one agrees"
    JUMPED_BACK = "the second of a new, earlier time"


class StampWatch:
    """Judges the stamps of one source.

    Args:
        back_ns: A step backwards beyond this is odd.
        ahead_ns: And so is one forwards beyond this.
        last_ns: The stamp before the first, if others of the same clock are known.
    """

    def __init__(self, back_ns: int, ahead_ns: int, last_ns: int | None = None) -> None:
        self._back_ns, self._ahead_ns = back_ns, ahead_ns
        self._last_ns = last_ns
        self._odd_ns: int | None = None

    def judge(self, stamp_ns: int) -> Step:
        """How this stamp follows; to be asked once for each message."""
        last_ns, odd_ns, self._odd_ns = self._last_ns, self._odd_ns, None
        step = Step.ONWARD
        if last_ns is not None and not -self._back_ns <= stamp_ns - last_ns <= self._ahead_ns:
            if odd_ns is None or not 0 < stamp_ns - odd_ns <= _AGREE_NS:
                self._odd_ns = stamp_ns
                return Step.ODD
            step = Step.JUMPED_BACK if stamp_ns < last_ns else Step.ONWARD
        self._last_ns = stamp_ns
        return step

    def reset(self) -> None:
        """Believe the next stamp."""
        self._last_ns = self._odd_ns = None
