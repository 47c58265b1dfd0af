"""How many of the raised hands in these photos are found, and how many are invented?"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment

from tracker.containers import BoolArray, CameraImage, FloatArray, Hands, Refusal
from tracker.errors import RecordingError
from tracker.evaluation.detection.looks import jittered_looks
from tracker.evaluation.detection.photo_labels import LabeledPhoto
from tracker.evaluation.metrics.intervals import wilson_interval
from tracker.perception import HandDetector
from tracker.recording.pictures import read_photo

#: A wrist farther from its label than this is another hand's; hands are labeled by eye.
_NEAR_HANDS, _NEAR_MIN_PX = 0.6, 12.0
#: Two false hands of neighboring looks are one within a hand's length, or so far.
_SAME_MIN_PX = 40.0
#: Traits with more values than this, such as names, say nothing.
_LEVELS_MAX = 8
_LOOK_NS = 100_000_000


@dataclass(frozen=True, slots=True, eq=False)
class JudgedPhoto:
    """What was found in one photo.

    Attributes:
        photo: With its labels.
        hands: The raised hands that were found in the look that tells most.
        is_found: Shape (R,): for each label, in any two looks in a row.
        is_false: Shape (H,): for each of `hands`, no label belongs to it, two looks in a row.
        delay_s: Shape (R,): from the first look until it was found; NaN where it was not.
        reasons: For each label why it was not found; empty for those found.
    """

    photo: LabeledPhoto
    hands: Hands
    is_found: BoolArray
    is_false: BoolArray
    delay_s: FloatArray
    reasons: tuple[str, ...]


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
        return _shares(self.photos)

    @property
    def shares_by(self) -> dict[str, dict[str, tuple[Share, ...]]]:
        """The same for each trait of the photos, and each of its values that several share."""
        names = dict.fromkeys(name for item in self.photos for name in item.photo.traits)
        answer: dict[str, dict[str, tuple[Share, ...]]] = {}
        for name in names:
            values = [item.photo.traits.get(name, "") for item in self.photos]
            if 1 < len(set(values)) <= _LEVELS_MAX:
                answer[name] = {
                    value or "-": _shares(
                        [item for item in self.photos if item.photo.traits.get(name, "") == value]
                    )
                    for value in sorted(set(values))
                }
        return answer

    @property
    def median_delay_s(self) -> float:
        """Of the hands that were found; NaN of none."""
        delays = [delay for item in self.photos for delay in item.delay_s[item.is_found].tolist()]
        return float(np.median(delays)) if len(delays) else float("nan")


def _shares(photos: Sequence[JudgedPhoto]) -> tuple[Share, ...]:
    found = sum(int(item.is_found.sum()) for item in photos)
    labels = sum(len(item.is_found) for item in photos)
    invented = sum(int(item.is_false.sum()) for item in photos)
    nobody = [item for item in photos if len(item.is_found) == 0]
    fooled = sum(bool(item.is_false.any()) for item in nobody)
    detections = sum(len(item.is_false) for item in photos)
    return (
        share_of("raised hands found", found, labels),
        share_of("false raises among all raises", invented, detections),
        share_of("photos without a call, with a false raise", fooled, len(nobody)),
    )


def study_photos(
    photos: Sequence[LabeledPhoto],
    detector: HandDetector,
    *,
    looks: int = 25,
    progress: Callable[[float, int], None] = lambda share, images: None,
) -> PhotoStudy:
    """Judge each photo on its own, as if a camera looked at the scene.

    Args:
        photos: With their labels.
        detector: Finds hands; it is reset before each photo.
        looks: How often each photo is shown, a tenth of a second apart and slightly changed
            (`jittered_looks`). A hand is found, or false, where it is raised in two looks in a
            row: so the tracker's streak has it. One look is the photo itself.
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
        shown = jittered_looks(bgr, looks, np.random.default_rng(number))
        seen = [
            detector.find(CameraImage(look * _LOOK_NS, "", picture))
            for look, picture in enumerate(shown)
        ]
        judged.append(judge_looks(photo, seen))
        progress(number / len(photos), number)
    return PhotoStudy(tuple(judged))


def judge_looks(photo: LabeledPhoto, seen: Sequence[Hands]) -> JudgedPhoto:
    """What two looks in a row agree on.

    Args:
        photo: With its labels.
        seen: Every hand of each look; of a single one, that one counts.
    """
    looks = [judge_photo(photo, hands[hands.raised]) for hands in seen]
    pairs = list(pairwise(looks)) or [(looks[0], looks[0])]
    found = np.stack([before.is_found & now.is_found for before, now in pairs])
    false = [now.is_false & _were_false(before, now.hands) for before, now in pairs]
    # The look with most false hands, of these the last.
    worst = max(range(len(pairs)), key=lambda row: (int(false[row].sum()), row))
    is_found: BoolArray = np.asarray(found.any(axis=0))
    delay_s = np.where(is_found, (found.argmax(axis=0) + 1) * _LOOK_NS / 1e9, np.nan)
    reasons = tuple(
        "" if is_found[row] else _reason(wrist, seen) for row, wrist in enumerate(photo.wrists_px)
    )
    return JudgedPhoto(photo, pairs[worst][1].hands, is_found, false[worst], delay_s, reasons)


def _were_false(before: JudgedPhoto, hands: Hands) -> BoolArray:
    """Shape (H,): hands at the place of one that was false in the look before."""
    old_px = before.hands.wrist_px[before.is_false]
    apart = np.linalg.norm(hands.wrist_px[:, None] - old_px, axis=-1)
    near = np.maximum(hands.length_px, _SAME_MIN_PX)
    return np.asarray((apart <= near[:, None]).any(axis=1))


def _reason(wrist_px: FloatArray, seen: Sequence[Hands]) -> str:
    """Why the hand at a place was not raised in most looks."""
    told: Counter[str] = Counter()
    for hands in seen:
        apart = np.linalg.norm(hands.wrist_px - wrist_px, axis=-1)
        near = np.flatnonzero(apart <= np.maximum(_NEAR_HANDS * hands.length_px, _NEAR_MIN_PX))
        words = "not found"
        if len(near):
            row = int(near[apart[near].argmin()])
            words = "raised" if hands.raised[row] else Refusal(int(hands.refusal[row])).words
        told[words] += 1
    return told.most_common(1)[0][0]


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
    delay_s = np.where(is_found, 0.0, np.nan)
    return JudgedPhoto(photo, hands, is_found, is_false, delay_s, ("",) * len(labels))


def photos_as_dict(study: PhotoStudy) -> dict[str, Any]:
    """A study in plain numbers, fit for JSON; None for what was not measured."""
    return {
        "totals": [_as_dict(item) for item in study.shares],
        "by": {
            name: {value: [_as_dict(item) for item in shares] for value, shares in levels.items()}
            for name, levels in study.shares_by.items()
        },
        "median_delay_s": None if np.isnan(study.median_delay_s) else study.median_delay_s,
        "photos": [
            {
                "file": item.photo.path.name,
                "raised": len(item.is_found),
                "found": int(item.is_found.sum()),
                "false": int(item.is_false.sum()),
                "reasons": "; ".join(filter(None, item.reasons)),
            }
            for item in study.photos
        ],
    }


def _as_dict(item: Share) -> dict[str, Any]:
    return {
        "name": item.name,
        "count": item.count,
        "total": item.total,
        "interval_95": [item.low, item.high] if item.total else None,
    }


def _nearest_pairs(labels: FloatArray, hands: Hands) -> list[tuple[int, int]]:
    apart = np.linalg.norm(labels[:, None] - hands.wrist_px[None], axis=-1)
    allowed = np.maximum(_NEAR_HANDS * hands.length_px, _NEAR_MIN_PX)
    is_near = apart <= allowed  # NaN, a label without a place, is not
    # As many pairs as there can be; among these, the nearest.
    rows, columns = linear_sum_assignment(np.where(is_near, apart, 1e6))
    pairs = zip(rows.tolist(), columns.tolist(), strict=True)
    return [(row, column) for row, column in pairs if is_near[row, column]]


def share_of(name: str, count: int, total: int) -> Share:
    """Some of many, with their interval."""
    return Share(name, count, total, *wilson_interval(count, total))
