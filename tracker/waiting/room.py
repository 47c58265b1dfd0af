"""Keeps images until their transforms come, and scans and transforms until images come.

Replay, both nodes and the evaluation use this one room. Time is the data's own.
"""

from __future__ import annotations

from collections import deque

from tracker.containers import DepthImage, Scan
from tracker.errors import ClockError
from tracker.transforms import StampedTransform, TransformBuffer, Transforms
from tracker.waiting.image_queue import ImageQueue
from tracker.waiting.stamp_watch import StampWatch, Step

#: Scans remembered; older ones give way.
_SCANS_KEPT = 40
#: Depth images remembered: two thirds of a second at 30 Hz, longer than images wait.
_DEPTHS_KEPT = 20
#: Transforms of one frame come in any order within the first. A step ahead beyond the second,
#: which is less than buffers remember, would outdate all others.
_TRANSFORM_LATE_NS, _TRANSFORM_AHEAD_NS = 1_000_000_000, 8_000_000_000
#: Frames whose stamps are watched; beyond these somebody invents names.
_FRAMES_WATCHED = 1000


class WaitingRoom:
    """Images, scans and transforms until they are needed.

    Args:
        rate_hz: Images admitted per second of their stamps.
        transforms: Knows where frames were; by default a buffer of the project's own.

    Attributes:
        images: Admitted images; the only part that other threads may use.
        transforms: As given.
    """

    def __init__(self, rate_hz: float, transforms: Transforms | None = None) -> None:
        self.images = ImageQueue(rate_hz)
        self.transforms: Transforms = transforms or TransformBuffer()
        self._scans: deque[Scan] = deque(maxlen=_SCANS_KEPT)
        self._depths: deque[DepthImage] = deque(maxlen=_DEPTHS_KEPT)
        self._watches: dict[str, StampWatch] = {}
        self._transforms_until_ns: int | None = None

    def add_scan(self, scan: Scan) -> None:
        """Take in one scan."""
        self._scans.append(scan)

    def add_depth(self, image: DepthImage) -> None:
        """Take in one depth image."""
        self._depths.append(image)

    def add_transform(self, sample: StampedTransform) -> None:
        """Take in one transform; where its clock has jumped back, those of before go.

        Raises:
            TransformError: It is unusable; see `TransformBuffer.add`.
            ClockError: Its stamp is negative, or far from the one before: alone in the buffer it
                would outdate all others. The new time is believed if the next one agrees.
        """
        if not sample.is_static:
            self._judge_transform(sample)
        self.transforms.add(sample)

    def scans_by_age(self, stamp_ns: int) -> list[Scan]:
        """The scans that wait, the nearest to a stamp first."""
        return sorted(self._scans, key=lambda scan: abs(scan.stamp_ns - stamp_ns))

    def depths_by_age(self, stamp_ns: int) -> list[DepthImage]:
        """The depth images that wait, the nearest to a stamp first."""
        return sorted(self._depths, key=lambda image: abs(image.stamp_ns - stamp_ns))

    def forget_scans_after(self, stamp_ns: int) -> None:
        """Drop what is later than a stamp: left over from before the clock jumped back."""
        for kept in (self._scans, self._depths):
            earlier = [each for each in kept if each.stamp_ns <= stamp_ns]
            kept.clear()
            kept.extend(earlier)  # type: ignore[arg-type]  # of the same kind

    def reset(self) -> None:
        """Forget everything but static transforms."""
        self.images.reset()
        self.transforms.clear()
        self._scans.clear()
        self._depths.clear()
        self._watches.clear()
        self._transforms_until_ns = None

    def _judge_transform(self, sample: StampedTransform) -> None:
        if len(self._watches) > _FRAMES_WATCHED:
            self._watches.clear()
        watch = self._watches.setdefault(
            sample.child,
            StampWatch(_TRANSFORM_LATE_NS, _TRANSFORM_AHEAD_NS, self._transforms_until_ns),
        )
        step = watch.judge(sample.stamp_ns)
        if step is Step.ODD:
            raise ClockError(
                f"The stamp {sample.stamp_ns / 1e9:.3f} s of the transform of {sample.child!r} "
                "is far from the one before; the new time is accepted if the next one agrees."
            )
        if step is Step.JUMPED_BACK:
            self.transforms.forget_after(sample.stamp_ns)
        self._transforms_until_ns = sample.stamp_ns
