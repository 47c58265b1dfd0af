"""Brightens dark pictures, and averages noisy ones where nothing moves.

The hand models know photos: in the light of a third of one, and under a noise of ten gray levels,
they miss two small hands of five that they find in clear pictures.
"""

from __future__ import annotations

import cv2
import numpy as np

from tracker.containers import ImageArray

#: A picture of which nearly everything is darker than this is brightened until that is `LIGHT`,
#: by no more than `GAIN_MAX`; gray levels.
DARK, LIGHT, GAIN_MAX = 110.0, 230.0, 4.0
#: Noise, in gray levels, from which still parts are averaged: twice that of an ordinary camera.
NOISE_MIN = 3.0
#: How much of the average each new picture is; seven pictures count.
NEW_SHARE = 0.25
#: Pixels that become one before pictures are compared, and the noise that is left of the green
#: channel's in such a pixel's gray level: it is the mean of 16, in three channels.
_SHRINK, _LEFT = 4, 0.25 * float(np.linalg.norm((0.114, 0.587, 0.299)))
#: What differs by so many standard deviations of noise has moved.
_MOVED_STD = 5.0
#: Measured at every so many rows and columns: reading few rows is what keeps it cheap.
_STEP = (32, 4)
_MEDIAN_STD = 0.6745  # median of what is normally distributed, without its sign


class PictureClearer:
    """Goes from image to image; clear pictures pass through as they are."""

    def __init__(self) -> None:
        self._mean: np.ndarray | None = None
        self.is_noisy = False

    def clear(self, bgr: ImageArray) -> ImageArray:
        """The picture as the models should see it, shape (height, width, 3), of the same shape.

        The very same where there is nothing to improve.
        """
        green = bgr[:, :, 1]
        noise_std = measure_noise(green)
        bright = _quantile(green[:: _STEP[0], :: _STEP[1]].astype(np.int16), 0.98)
        gain = min(LIGHT / max(bright, 1.0), GAIN_MAX) if bright < DARK else 1.0
        self.is_noisy = noise_std >= NOISE_MIN
        if not self.is_noisy:
            self._mean = None
            return bgr if gain == 1.0 else _brighten(bgr, gain)
        if self._mean is None or self._mean.shape != bgr.shape:
            self._mean = bgr.astype(np.float32)
        else:
            moved = _has_moved(bgr, self._mean, noise_std)
            cv2.accumulateWeighted(bgr, self._mean, NEW_SHARE, 1 - moved)
            cv2.accumulateWeighted(bgr, self._mean, 1.0, moved)
        return _brighten(self._mean, gain)

    def reset(self) -> None:
        """Forget earlier images."""
        self._mean = None


def measure_noise(gray: ImageArray) -> float:
    """Standard deviation of the noise of a picture (height, width), in gray levels.

    Source: Immerkaer, "Fast Noise Variance Estimation", Computer Vision and Image Understanding
        64(2), 1996; with the median for the mean, which edges would pull up.
    """
    rows, columns = _STEP
    height, width = (max(size - 2, 0) for size in gray.shape)
    # Slopes and curves of the picture cancel out; of noise, 6 standard deviations are left.
    above, here, below = (gray[row : row + height : rows].astype(np.int16) for row in range(3))
    bent = above - 2 * here + below
    left, here, right = (bent[:, column : column + width : columns] for column in range(3))
    bent = left - 2 * here + right
    return _quantile(np.abs(bent), 0.5) / (6.0 * _MEDIAN_STD) if bent.size else 0.0


def _quantile(values: np.ndarray, share: float) -> float:
    """The nearest of many values; NumPy's own interpolates, at four times the cost.

    Whole numbers of 16 bits are the fastest to order.
    """
    row = round(share * (values.size - 1))
    return float(np.partition(values, row, axis=None)[row])


def _brighten(bgr: np.ndarray, gain: float) -> ImageArray:
    return np.asarray(cv2.convertScaleAbs(bgr, alpha=gain), dtype=np.uint8)


def _has_moved(bgr: ImageArray, mean: np.ndarray, noise_std: float) -> ImageArray:
    """Mask of shape (height, width): where a picture is unlike the average by more than noise."""
    height, width = bgr.shape[:2]
    size = (max(1, width // _SHRINK), max(1, height // _SHRINK))
    new, old = (
        cv2.cvtColor(cv2.resize(picture, size, interpolation=cv2.INTER_AREA), cv2.COLOR_BGR2GRAY)
        for picture in (bgr, mean)
    )
    is_unlike = cv2.absdiff(new.astype(np.float32), old) > _MOVED_STD * _LEFT * noise_std
    grown = cv2.dilate(is_unlike.astype(np.uint8), np.ones((3, 3), np.uint8))
    mask = cv2.resize(grown, (width, height), interpolation=cv2.INTER_NEAREST)
    return np.asarray(mask, dtype=np.uint8)
