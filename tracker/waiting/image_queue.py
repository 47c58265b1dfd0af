"""Which images wait for their transforms? Those that the gate admits, oldest first.

The only part of the waiting room that two threads may use: a node's callbacks offer, its worker
takes.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from typing import NamedTuple

from tracker.containers import CameraImage
from tracker.waiting.image_gate import ImageGate, Verdict

#: Images that may wait at a time; of more, the oldest give way.
IMAGES_KEPT = 16


class WaitingImage(NamedTuple):
    """An image whose turn will come.

    Attributes:
        stamp_ns: When it was taken.
        frame_id: The camera's frame; empty means the configured one.
        since_ns: When it came, on the clock that patience is measured with.
        open: Decodes it; called only when its turn has come. May raise a TrackerError.
    """

    stamp_ns: int
    frame_id: str
    since_ns: int
    open: Callable[[], CameraImage]


class ImageQueue:
    """Bounded, and never slow for who offers.

    Args:
        rate_hz: Images admitted per second of their stamps, on average.

    Attributes:
        lost: Admitted images that were never taken, because others came faster than they left.
    """

    def __init__(self, rate_hz: float) -> None:
        self._lock = threading.Lock()
        self._gate = ImageGate(rate_hz)
        self._images = deque[WaitingImage]()
        self.lost = 0

    def __len__(self) -> int:
        return len(self._images)

    def offer(self, image: WaitingImage) -> Verdict:
        """Keep an image, if its stamp makes sense and it is its turn."""
        with self._lock:
            verdict = self._gate.judge(image.stamp_ns)
            if verdict is Verdict.JUMPED_BACK:
                self._images.clear()  # those are of the time before
            if verdict.is_admitted:
                if len(self._images) == IMAGES_KEPT:
                    self._images.popleft()
                    self.lost += 1
                self._images.append(image)
        return verdict

    def take(
        self, is_ready: Callable[[WaitingImage], bool], *, at_most: int
    ) -> list[WaitingImage]:
        """Take out the images that are ready, oldest first, up to the first that is not.

        Args:
            is_ready: Whether an image need not wait any longer.
            at_most: Of more than these only the newest count, the others are lost.
        """
        with self._lock:
            waiting = list(self._images)
        count = 0
        while count < len(waiting) and is_ready(waiting[count]):
            count += 1
        ready = waiting[:count]
        with self._lock:
            # Meanwhile others may have been added to the end, or have pushed out the first.
            while self._images and any(self._images[0] is image for image in ready):
                self._images.popleft()
            self.lost += max(len(ready) - at_most, 0)
        return ready[-at_most:]

    def next(self, is_ready: Callable[[WaitingImage], bool]) -> WaitingImage | None:
        """Take out the oldest image, if it is ready or the queue is full; loses none."""
        with self._lock:
            first = self._images[0] if self._images else None
            if first is None or not (len(self._images) == IMAGES_KEPT or is_ready(first)):
                return None
            return self._images.popleft()

    def set_rate(self, rate_hz: float) -> None:
        """Change the rate, from the next image on."""
        with self._lock:
            self._gate.set_rate(rate_hz)

    def reset(self) -> None:
        """Forget the images, and believe the next one whatever its stamp."""
        with self._lock:
            self._images.clear()
            self._gate.reset()
