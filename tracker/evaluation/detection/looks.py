"""How does a photo look as a video? The same scene again and again, slightly moved and noisy."""

from __future__ import annotations

from collections.abc import Iterator

import cv2
import numpy as np

from tracker.containers import ImageArray

#: A camera on a robot that stands: it sways by so many pixels, each has noise of so many gray
#: levels, and the light of the picture changes by as many.
SWAY_PX, NOISE_STD, LIGHT = 1.2, 2.0, 2


def jittered_looks(bgr: ImageArray, looks: int, rng: np.random.Generator) -> Iterator[ImageArray]:
    """A photo shown several times; once is the photo itself.

    Args:
        bgr: Shape (height, width, 3).
        looks: How often.
        rng: Sway, noise and light.
    """
    if looks == 1:
        yield bgr
        return
    size = bgr.shape[1], bgr.shape[0]
    for _ in range(looks):
        shift = np.column_stack([np.eye(2), rng.uniform(-SWAY_PX, SWAY_PX, 2)])
        moved = cv2.warpAffine(bgr, shift, size, borderMode=cv2.BORDER_REPLICATE)
        noise = rng.normal(0.0, NOISE_STD, bgr.shape) + rng.integers(-LIGHT, LIGHT + 1)
        yield np.clip(moved + noise, 0, 255).astype(np.uint8)
