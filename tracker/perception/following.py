"""Which hands of the last image are still there, and which are new?

A hand that was found is looked for around its old place, which spares the search and keeps the
order of rows; only while fewer hands are followed than allowed is the picture searched for more.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray, CameraImage, ImageArray
from tracker.perception.landmarks import Landmarks
from tracker.perception.palm_search import Palms, Window
from tracker.perception.regions import (
    Regions,
    overlap,
    regions_from_landmarks,
    regions_from_palms,
)

#: Regions that overlap more than this hold the same hand; MediaPipe's value.
SAME_REGION_OVERLAP = 0.5
#: Two regions led to the same hand if their landmarks lie closer than this, on average, in sides
#: of the region (a hand's own length is about half a side). Read twice, from the palm's and from
#: the landmarks' region, the 89 hands of 56 photos (both complexities) moved by 0.01 in the
#: median, 0.03 at the ninth decile. How close two clasped hands come is not measured.
SAME_HAND_DISTANCE = 0.05


class Searcher(Protocol):
    """What `following` needs of a `PalmSearch`."""

    def find(
        self, bgr: ImageArray, confidence: float, *, window: Window | None = None, shrink: int = 1
    ) -> Palms:
        """Palms of a picture, the surest first."""
        ...


class Reader(Protocol):
    """What `following` needs of a `LandmarkReader`."""

    def read(self, bgr: ImageArray, regions: Regions) -> Landmarks:
        """Landmarks in each region."""
        ...


class HandFollower:
    """Goes from image to image with the hands it knows.

    Args:
        searcher: Finds palms.
        reader: Reads landmarks.
    """

    def __init__(self, searcher: Searcher, reader: Reader) -> None:
        self._searcher = searcher
        self._reader = reader
        self._regions = Regions.none()
        self._last: CameraImage | None = None

    def step(self, image: CameraImage, config: Config) -> Landmarks:
        """Every hand of the next image; followed ones first, in the order of the last image.

        A stamp that jumps back, another frame_id or another size of the image starts anew.
        """
        if self._last is None or not _continues(self._last, image):
            self.reset()
        self._last = image
        regions = self._regions[: config.max_hands]
        room = config.max_hands - len(regions)
        if room > 0:
            palms = self._searcher.find(
                image.bgr, config.detection_confidence, shrink=config.downscale_factor
            )
            found = _usable(regions_from_palms(palms.boxes_px, palms.keypoints_px))
            regions = Regions.concatenate(regions, drop_known(found, regions)[:room])
        hands = self._reader.read(image.bgr, regions)
        hands = drop_repeated(hands[hands.score >= config.tracking_confidence])
        self._regions = _usable(regions_from_landmarks(hands.points_px))
        return hands

    def reset(self) -> None:
        """Follow nobody any more."""
        self._regions = Regions.none()
        self._last = None


def drop_known(found: Regions, known: Regions) -> Regions:
    """The found regions that hold neither a known hand nor one that stands earlier among them."""
    is_new = ~(overlap(found, known) > SAME_REGION_OVERLAP).any(axis=-1)
    found = found[is_new]
    return found[_first_of_each(overlap(found, found) > SAME_REGION_OVERLAP, range(len(found)))]


def drop_repeated(hands: Landmarks) -> Landmarks:
    """One row per hand where several regions led to the same one; the surest stays."""
    side = regions_from_landmarks(hands.points_px).side_px
    apart = hands.points_px[:, None] - hands.points_px[None]
    distance = np.linalg.norm(apart, axis=-1).mean(axis=-1)
    same = distance < SAME_HAND_DISTANCE * np.minimum(side[:, None], side[None, :])
    return hands[_first_of_each(same, np.argsort(-hands.score, kind="stable").tolist())]


def _first_of_each(same: BoolArray, order: Iterable[int]) -> BoolArray:
    """Mask of the rows that are not the same as a row kept before them in `order`."""
    keep = np.zeros(len(same), dtype=bool)
    for row in order:
        keep[row] = not np.any(same[row] & keep)
    return keep


def _continues(last: CameraImage, image: CameraImage) -> bool:
    return (
        image.stamp_ns >= last.stamp_ns
        and image.frame_id == last.frame_id
        and image.bgr.shape == last.bgr.shape
    )


def _usable(regions: Regions) -> Regions:
    finite = np.isfinite(regions.center_px).all(axis=-1) & np.isfinite(regions.rotation_rad)
    return regions[finite & (regions.side_px > 1.0) & np.isfinite(regions.side_px)]
