"""Where has something moved since the last image? A cheap look at two small gray pictures."""

from __future__ import annotations

import cv2
import numpy as np

from tracker.containers import FloatArray, ImageArray

#: Pixels that become one before pictures are compared; a hand at three meters stays 3 x 2.
SHRINK = 8
#: Gray levels; a camera's noise, averaged over 64 pixels, is below one.
DIFFERENCE_MIN = 8
#: Where more of the picture than this has changed, the camera itself has moved: that says nothing.
CHANGED_MAX = 0.3
#: Pixels of the small picture, after each spot grew by one all around: more than a single pixel.
_AREA_MIN = 10


class Movement:
    """Compares each image with the one before."""

    def __init__(self) -> None:
        self._last: ImageArray | None = None

    def boxes(self, bgr: ImageArray) -> FloatArray:
        """Where something moved since the last picture, which has shape (height, width, 3) too.

        Returns:
            Shape (M, 4): x_min, y_min, x_max, y_max in pixels; none for a first picture, or one of
            another size.
        """
        height, width = bgr.shape[:2]
        size = (max(1, width // SHRINK), max(1, height // SHRINK))
        small = cv2.cvtColor(
            cv2.resize(bgr, size, interpolation=cv2.INTER_AREA), cv2.COLOR_BGR2GRAY
        )
        last, self._last = self._last, np.asarray(small, dtype=np.uint8)
        if last is None or last.shape != small.shape:
            return np.zeros((0, 4))
        changed = (cv2.absdiff(small, last) >= DIFFERENCE_MIN).astype(np.uint8)
        if changed.mean() > CHANGED_MAX:
            return np.zeros((0, 4))
        joined = cv2.dilate(changed, np.ones((3, 3), np.uint8))
        _, _, spots, _ = cv2.connectedComponentsWithStats(joined)
        spots = spots[1:]  # row 0 is what has not moved
        spots = spots[spots[:, cv2.CC_STAT_AREA] >= _AREA_MIN].astype(np.float64)
        corner, extent = spots[:, :2], spots[:, 2:4]
        scale = np.tile([width / size[0], height / size[1]], 2)
        return np.asarray(np.concatenate([corner, corner + extent], axis=-1) * scale)

    def reset(self) -> None:
        """Forget the last image."""
        self._last = None
