"""How many of the raised hands in these photos are found, and how many are invented?"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment

from tracker.containers import BoolArray, CameraImage, FloatArray, Hands
from tracker.errors import RecordingError
from tracker.evaluation.detection.photo_labels import LabeledPhoto
from tracker.evaluation.metrics.intervals import wilson_interval
from tracker.perception import HandDetector
from tracker.recording.pictures import read_photo

#: A wrist farther from its label than this is another hand's; hands are labeled by eye.
_NEAR_HANDS, _NEAR_MIN_PX = 0.5, 10.0
_LOOK_NS = 100_000_000


@dataclass(frozen=True, slots=True, eq=False)
class JudgedPhoto:
    """What was found in one photo.

    Attributes:
        photo: With its labels.
        hands: The raised hands that were found.
        is_found: Shape (R,): for each label.
        is_false: Shape (H,): for each of `hands`, no label belongs to it.
    """

    photo: LabeledPhoto
    hands: Hands
    is_found: BoolArray
    is_false: BoolArray


@dataclass(frozen=True, slots=True)
class Share:
    """Some of many.

    Attributes:
        name: What is counted.
        count: How many.
        total: Of how many.
        low: 95 % interval of the share, by Wilson; NaN of none.
        high: Its other end.
    """

    name: str
    count: int
    total: int
    low: float
    high: float


@dataclass(frozen=True, slots=True, eq=False)
class PhotoStudy:
    """What was found in the photos.

    Attributes:
        photos: In the order of the labels.
    """

    photos: tuple[JudgedPhoto, ...]

    @property
    def shares(self) -> tuple[Share, ...]:
        """The totals."""
        found = sum(int(item.is_found.sum()) for item in self.photos)
        labels = sum(len(item.is_found) for item in self.photos)
        invented = sum(int(item.is_false.sum()) for item in self.photos)
        nobody = [item for item in self.photos if len(item.is_found) == 0]
        fooled = sum(bool(item.is_false.any()) for item in nobody)
        detections = sum(len(item.is_false) for item in self.photos)
        return (
            _share("raised hands found", found, labels),
            _share("of the hands called raised, false", invented, detections),
            _share("photos of nobody with a false one", fooled, len(nobody)),
        )


def study_photos(
    photos: Sequence[LabeledPhoto],
    detector: HandDetector,
    *,
    looks: int = 1,
    progress: Callable[[float, int], None] = lambda share, images: None,
) -> PhotoStudy:
    """Judge each photo on its own.

    Args:
        photos: With their labels.
        detector: Finds hands; it is reset before each photo.
        looks: How often each photo is shown, a tenth of a second apart; the last one counts.
        progress: Told the share that is done, and the number of photos.

    Raises:
        RecordingError: A photo cannot be read, or is labeled outside its edges.
    """
    judged = []
    for number, photo in enumerate(photos, start=1):
        bgr = read_photo(photo.path)
        height, width = bgr.shape[:2]
        if np.any(photo.wrists_px >= (width, height)):  # NaN is not
            raise RecordingError(
                f"{photo.path}: a wrist is labeled outside the photo, which has {width} x "
                f"{height} pixels; correct x, y."
            )
        detector.reset()
        hands = Hands.none()
        for look in range(looks):
            hands = detector.find(CameraImage(look * _LOOK_NS, "", bgr))
        judged.append(judge_photo(photo, hands[hands.raised]))
        progress(number / len(photos), number)
    return PhotoStudy(tuple(judged))


def judge_photo(photo: LabeledPhoto, hands: Hands) -> JudgedPhoto:
    """Pair labels and raised hands: first those with a place, then any that are left.

    Args:
        photo: With its labels.
        hands: Those called raised.
    """
    labels = photo.wrists_px
    is_placed = np.isfinite(labels).all(axis=-1)
    is_found, is_false = np.zeros(len(labels), bool), np.ones(len(hands), bool)
    for label, hand in _nearest_pairs(labels, hands):
        is_found[label], is_false[hand] = True, False
    unplaced = np.flatnonzero(~is_placed)
    left = np.flatnonzero(is_false)
    count = min(len(unplaced), len(left))
    is_found[unplaced[:count]], is_false[left[:count]] = True, False
    return JudgedPhoto(photo, hands, is_found, is_false)


def photos_as_dict(study: PhotoStudy) -> dict[str, Any]:
    """A study in plain numbers, fit for JSON; None for what was not measured."""
    return {
        "totals": [
            {
                "name": item.name,
                "count": item.count,
                "total": item.total,
                "interval_95": [item.low, item.high] if item.total else None,
            }
            for item in study.shares
        ],
        "photos": [
            {
                "file": item.photo.path.name,
                "raised": len(item.is_found),
                "found": int(item.is_found.sum()),
                "false": int(item.is_false.sum()),
            }
            for item in study.photos
        ],
    }


def _nearest_pairs(labels: FloatArray, hands: Hands) -> list[tuple[int, int]]:
    apart = np.linalg.norm(labels[:, None] - hands.wrist_px[None], axis=-1)
    allowed = np.maximum(_NEAR_HANDS * hands.length_px, _NEAR_MIN_PX)
    is_near = apart <= allowed  # NaN, a label without a place, is not
    # As many pairs as there can be; among these, the nearest.
    rows, columns = linear_sum_assignment(np.where(is_near, apart, 1e6))
    pairs = zip(rows.tolist(), columns.tolist(), strict=True)
    return [(row, column) for row, column in pairs if is_near[row, column]]


def _share(name: str, count: int, total: int) -> Share:
    return Share(name, count, total, *wilson_interval(count, total))
