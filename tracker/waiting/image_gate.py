"""Which images are worth keeping? Those whose stamp makes sense and whose turn it is."""

from __future__ import annotations

from enum import Enum

from tracker.waiting.rate_limiter import RateLimiter
from tracker.waiting.stamp_watch import StampWatch, Step

#: A camera that pauses longer than this loses one image more until its time is believed.
_LEAP_NS = 10_000_000_000
#: Images out of order come within this; more is a clock that was set back.
_LATE_NS = 500_000_000


class Verdict(Enum):
    """Whether an image is processed; the value says why."""

    ADMITTED = "its turn"
    JUMPED_BACK = "its turn, and the first of a new time"
    NOT_DUE = "not its turn at processing_rate"
    REPEATED = "the same stamp as the image before; does the driver fill in header.stamp?"
    LATE = "earlier than the image before, out of order"
    ODD = "far from the stamp before; the new time is accepted if the next image agrees"

    @property
    def is_admitted(self) -> bool:
        """Whether the image is to be processed."""
        return self in (Verdict.ADMITTED, Verdict.JUMPED_BACK)

    @property
    def is_refused(self) -> bool:
        """Whether the image is left out because of its stamp."""
        return not self.is_admitted and self is not Verdict.NOT_DUE


class ImageGate:
    """Judges the images of one camera by their stamps, and admits `processing_rate` of them.

    Args:
        rate_hz: `processing_rate`.
    """

    def __init__(self, rate_hz: float) -> None:
        self._limiter = RateLimiter(rate_hz)
        self._watch = StampWatch(_LATE_NS, _LEAP_NS)
        self._last_ns: int | None = None

    def judge(self, stamp_ns: int) -> Verdict:
        """What is to be done with the image of this stamp; to be asked once for each image."""
        last_ns, self._last_ns = self._last_ns, stamp_ns
        if stamp_ns == last_ns:
            return Verdict.REPEATED
        step = self._watch.judge(stamp_ns)
        if step in (Step.LATE, Step.ODD):
            return Verdict[step.name]
        if not self._limiter.admits(stamp_ns):
            return Verdict.NOT_DUE
        return Verdict.JUMPED_BACK if step is Step.JUMPED_BACK else Verdict.ADMITTED

    def set_rate(self, rate_hz: float) -> None:
        """Change the rate, from the next image on."""
        self._limiter.set_rate(rate_hz)

    def reset(self) -> None:
        """Believe and admit the next image, whatever its stamp."""
        self._limiter.reset()
        self._watch.reset()
        self._last_ns = None
