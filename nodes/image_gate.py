"""Which images are worth storing? Those whose stamp makes sense and whose turn it is."""

from __future__ import annotations

from enum import Enum

from nodes.stamp_watch import StampWatch, Step
from tracker.rate_limiter import RateLimiter

#: A camera that pauses longer than this loses one image more until its time is believed.
_LEAP_NS = 10_000_000_000


class Verdict(Enum):
    """What is to be done with an image."""

    ADMITTED = "its turn"
    PASSED_OVER = "not its turn at processing_rate"
    REPEATED = "the same stamp as the image before"
    ODD = "a stamp far from the one before"
    JUMPED_BACK = "its turn, and the first of a new time"


class ImageGate:
    """Judges the images of one camera by their stamps, and admits `processing_rate` of them.

    Args:
        rate_hz: `processing_rate`.
    """

    def __init__(self, rate_hz: float) -> None:
        self._limiter = RateLimiter(rate_hz)
        self._watch = StampWatch(back_ns=0, ahead_ns=_LEAP_NS)
        self._last_ns: int | None = None

    def judge(self, stamp_ns: int) -> Verdict:
        """What is to be done with the image of this stamp; to be asked once for each image."""
        last_ns, self._last_ns = self._last_ns, stamp_ns
        if stamp_ns == last_ns:
            return Verdict.REPEATED
        step = self._watch.judge(stamp_ns)
        if step is Step.ODD:
            return Verdict.ODD
        if not self._limiter.admits(stamp_ns):
            return Verdict.PASSED_OVER
        return Verdict.JUMPED_BACK if step is Step.JUMPED_BACK else Verdict.ADMITTED

    def set_rate(self, rate_hz: float) -> None:
        """Change the rate, from the next image on."""
        self._limiter.set_rate(rate_hz)

    def reset(self) -> None:
        """Believe and admit the next image, whatever its stamp."""
        self._limiter.reset()
        self._watch.reset()
        self._last_ns = None
