"""Does this stamp make sense after those before?

One odd stamp is an error, two in a row that agree are a new time: a single broken or reordered
message must not reset everybody's tracks, a recording that loops must.
"""

from __future__ import annotations

from enum import Enum

#: So many late messages in a row are no disorder: the clock was set back by a little.
_LATE_IN_A_ROW = 100


class Step(Enum):
    """How a stamp follows those before."""

    ONWARD = "as it should"
    LATE = "a little earlier than the newest one, as with messages out of order"
    ODD = "far from the newest one; accepted if the next one agrees"
    JUMPED_BACK = "part of a new, earlier time"


class StampWatch:
    """Judges the stamps of one source.

    Args:
        late_ns: A step backwards up to this is late, one beyond it odd.
        ahead_ns: A step forwards beyond this is odd; two odd stamps in a row that are no farther
            apart agree on a new time.
        last_ns: The stamp before the first, if others of the same clock are known.
    """

    def __init__(self, late_ns: int, ahead_ns: int, last_ns: int | None = None) -> None:
        self._late_ns, self._ahead_ns = late_ns, ahead_ns
        self._newest_ns = last_ns
        self._odd_ns: int | None = None
        self._late_count = 0

    def judge(self, stamp_ns: int) -> Step:
        """How this stamp follows; to be asked once for each message."""
        newest_ns, odd_ns, self._odd_ns = self._newest_ns, self._odd_ns, None
        if newest_ns is None or 0 <= stamp_ns - newest_ns <= self._ahead_ns:
            return self._believe(stamp_ns, Step.ONWARD)
        if -self._late_ns <= stamp_ns - newest_ns < 0:
            self._late_count += 1
            if self._late_count < _LATE_IN_A_ROW:
                return Step.LATE
            return self._believe(stamp_ns, Step.JUMPED_BACK)
        if odd_ns is None or not 0 < stamp_ns - odd_ns <= self._ahead_ns:
            self._odd_ns = stamp_ns
            return Step.ODD
        return self._believe(stamp_ns, Step.JUMPED_BACK if stamp_ns < newest_ns else Step.ONWARD)

    def reset(self) -> None:
        """Believe the next stamp."""
        self._newest_ns = self._odd_ns = None
        self._late_count = 0

    def _believe(self, stamp_ns: int, step: Step) -> Step:
        self._newest_ns, self._late_count = stamp_ns, 0
        return step
