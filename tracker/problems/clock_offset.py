"""Are the stamps of a sensor later than the arrival of its messages? Then its clock is wrong."""

from __future__ import annotations

from collections import deque
from statistics import median

_MESSAGES = 50


class ClockOffset:
    """How far the stamps of one sensor lie before or after their arrival.

    A stamp long before arrival may be an honest latency; one after it cannot be right, unless the
    sensor's clock and the receiver's differ.
    """

    def __init__(self) -> None:
        self._offset_s: deque[float] = deque(maxlen=_MESSAGES)

    def add(self, stamp_ns: int, arrived_ns: int) -> None:
        """Take in one message.

        Args:
            stamp_ns: The sensor's.
            arrived_ns: On the receiver's clock, or when it was recorded.
        """
        self._offset_s.append((stamp_ns - arrived_ns) / 1e9)

    def ahead_s(self) -> float:
        """Median of stamp minus arrival over the last messages; 0 before the first."""
        return median(self._offset_s) if self._offset_s else 0.0
