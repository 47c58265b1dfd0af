"""What does the person behind a raised hand wear? A color histogram of the chest.

The chest is where anatomy puts it: below the wrist, on the side to which the thumb points, in
lengths of the palm. Histograms live on the disc of hue and saturation, without brightness: a cloud
before the sun changes no colors. Both coordinates are binned softly, and the disc's center is a
bin of its own, because gray has no hue.
"""

from __future__ import annotations

import cv2
import numpy as np

from tracker.containers import FloatArray, Hands, ImageArray, IntArray

_HUES = 12
#: Saturation of the center and of the rings; what lies between is shared by its neighbors.
_RINGS = np.array([0.0, 0.3, 0.7])
#: Numbers of a histogram.
BINS = 1 + _HUES * (len(_RINGS) - 1)
#: In the dark, noise looks like color: saturation is taken of at least this brightness (of 255).
_BRIGHTNESS_MIN = 50.0

#: The chest beside and below the wrist of a hand held up beside the head, in palm lengths (after
#: the simulated figure: 0.39 m from the body's middle, shoulders 0.18 m lower; palms are 0.095 m).
_BESIDE, _BELOW, _HALF_WIDTH, _HALF_HEIGHT = 4.0, 4.2, 1.4, 1.8
#: A thumb so close (in palm lengths) to the little finger's side shows a hand edge-on.
_THUMB_MIN = 0.25
#: Smaller palms belong to chests of a few blurred pixels.
_PALM_MIN_PX = 5.0
#: Share of the chest that must be in the picture.
_VISIBLE_MIN = 0.4
#: The chest is shrunk to so many pixels each way: enough for colors, and noise averages out.
_SIDE_PX = 24
_WRIST, _THUMB_TIP, _MIDDLE_ROOT, _PINKY_ROOT = 0, 4, 9, 17


def clothes_histograms(bgr: ImageArray, hands: Hands) -> FloatArray:
    """Color histograms of the clothes beside hands that are up.

    Args:
        bgr: Shape (height, width, 3), the full image.
        hands: Held up beside the head, in its pixels.

    Returns:
        Shape (H, BINS), each row adding up to 1: gray first, then the hues of a pale and of a
        vivid ring. Rows of NaN where the chest is too small or outside of the picture, or where
        an edge-on hand does not tell on which side it is.
    """
    histograms = np.full((len(hands), BINS), np.nan)
    for row, box in enumerate(_chests(hands)):
        chest = _cut(bgr, box)
        if chest is not None:
            histograms[row] = _histogram(chest)
    return histograms


def _chests(hands: Hands) -> FloatArray:
    """Left, top, right, bottom of each chest, shape (H, 4), pixels; NaN where it is unknown."""
    points = hands.landmarks_px
    palm = np.linalg.norm(points[:, _MIDDLE_ROOT] - points[:, _WRIST], axis=-1)
    toward = points[:, _THUMB_TIP, 0] - points[:, _PINKY_ROOT, 0]
    known = (palm >= _PALM_MIN_PX) & (np.abs(toward) >= _THUMB_MIN * palm)
    palm = np.where(known, palm, np.nan)
    middle = points[:, _WRIST] + np.stack([np.sign(toward) * _BESIDE * palm, _BELOW * palm], -1)
    half = np.stack([_HALF_WIDTH * palm, _HALF_HEIGHT * palm], axis=-1)
    return np.concatenate([middle - half, middle + half], axis=-1)


def _cut(bgr: ImageArray, box: FloatArray) -> ImageArray | None:
    """What a picture shows of a box, shrunk; None where that is too little."""
    if not np.isfinite(box).all():
        return None
    height, width = bgr.shape[:2]
    inside = np.clip(box, 0.0, [width, height, width, height])
    share = np.prod(inside[2:] - inside[:2]) / np.prod(box[2:] - box[:2])
    left, top, right, bottom = np.round(inside).astype(int)
    if share < _VISIBLE_MIN or right <= left or bottom <= top:
        return None
    part = bgr[top:bottom, left:right]
    size = (min(_SIDE_PX, right - left), min(_SIDE_PX, bottom - top))
    return np.asarray(cv2.resize(part, size, interpolation=cv2.INTER_AREA), np.uint8)


def _histogram(bgr: ImageArray) -> FloatArray:
    hsv = cv2.cvtColor(bgr.astype(np.float32), cv2.COLOR_BGR2HSV).reshape(-1, 3)
    brightness = hsv[:, 2]
    saturation = hsv[:, 1] * brightness / np.maximum(brightness, _BRIGHTNESS_MIN)
    ring, outward = _between(np.interp(saturation, _RINGS, np.arange(len(_RINGS))))
    hue, onward = _between(np.asarray(hsv[:, 0] * (_HUES / 360.0), np.float64))
    counts = np.zeros(BINS)
    for rings, ring_share in ((ring, 1.0 - outward), (ring + 1, outward)):
        for hues, hue_share in ((hue, 1.0 - onward), (hue + 1, onward)):
            place = np.where(rings > 0, 1 + (rings - 1) * _HUES + hues % _HUES, 0)
            place = np.minimum(place, BINS - 1)  # beyond the last ring there is no share
            counts += np.bincount(place, ring_share * hue_share, BINS)
    return np.asarray(counts / counts.sum())


def _between(position: FloatArray) -> tuple[IntArray, FloatArray]:
    """The bin below a position, and the share of the next one."""
    below = np.floor(position).astype(np.int64)
    return below, position - below
