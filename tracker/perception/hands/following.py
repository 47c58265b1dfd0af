"""Which hands of the last image are still there, and which are new?

A hand that was found is looked for around its old place, which spares the search and keeps the
order of rows. At the same time the picture is searched for more, a few places in each image.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from functools import partial

import cv2
import numpy as np

from tracker.config import Config
from tracker.containers import (
    BoolArray,
    CameraImage,
    FloatArray,
    ImageArray,
    IntArray,
    PerceptionWork,
)
from tracker.perception.hands.clearing import PictureClearer
from tracker.perception.hands.landmarks import LandmarkReader, Landmarks
from tracker.perception.hands.seen_picture import SeenPicture
from tracker.perception.movement import Movement
from tracker.perception.pictures import Window, continues
from tracker.perception.regions import (
    Regions,
    first_of_each,
    overlap,
    regions_from_landmarks,
    regions_from_palms,
)
from tracker.perception.search_plan import SearchPlan
from tracker.perception.single_shot import Detections, SingleShot
from tracker.perception.verdict.raise_rules import WRIST

#: Regions that overlap more than this hold the same hand; MediaPipe's value.
SAME_REGION_OVERLAP = 0.5
#: Two regions led to the same hand if their landmarks lie closer than this, on average, in sides
#: of the region (a hand's own length is about half a side). Read twice, from the palm's and from
#: the landmarks' region, the 89 hands of 56 photos (both complexities) moved by 0.01 in the
#: median, 0.03 at the ninth decile. How close two clasped hands come is not measured.
SAME_HAND_DISTANCE = 0.05
#: A hand this many times smaller than another one that covers its middle is a part of it.
SMALLER_HAND = 1.4
#: Two hands do not begin at one wrist; so close, in lengths of the longer one, they are one.
SAME_WRIST_DISTANCE = 0.1
#: The side of a region, in lengths of the hand.
SIDE_HANDS = 2.0
#: A new hand that scores too low, but from here on, is read a second time; so many in an image.
PROMISING_SCORE, MOST_AGAIN = 0.1, 2
#: So much a noisy picture is smoothed for it, as standard deviation, for regions whose side is so
#: long: of a real man who waves before a noisy camera 64 hands of 125 are found in place of 34; of
#: drawn hands below 24 px one of twenty fewer.
SMOOTH_PX, SMOOTH_FROM_PX = 1.0, 48.0
_NOWHERE = np.zeros((0, 4))
_NO_REGIONS = Regions.none()


class HandFollower:
    """Goes from image to image with the hands it knows.

    Args:
        whole: Finds palms in the whole picture.
        pieces: Finds palms in windows of it.
        reader: Reads landmarks.
    """

    def __init__(self, whole: SingleShot, pieces: SingleShot, reader: LandmarkReader) -> None:
        self._whole = whole
        self._pieces = pieces
        self._reader = reader
        self._plan: SearchPlan | None = None
        self._clearer = PictureClearer()
        self._movement = Movement()
        self._regions = _NO_REGIONS
        self._rows = np.zeros(0, dtype=np.int64)
        self._last: CameraImage | None = None
        self.work = PerceptionWork()
        self.seen: SeenPicture | None = None

    def step(
        self,
        image: CameraImage,
        config: Config,
        expected_px: FloatArray = _NOWHERE,
        budget: int | None = None,
        suggested: Regions | None = None,
        spared: int = 0,
    ) -> tuple[Landmarks, IntArray]:
        """Every hand of the next image; followed ones first, in the order of the last image.

        A stamp that jumps back, another frame_id or another size of the image starts anew.

        Args:
            image: The next image.
            config: The perception group.
            expected_px: Shape (E, 4): windows in which a raised hand is likelier than elsewhere.
            budget: Model runs, of the palm search and on followed hands, that the image may take;
                the search shrinks for it, down to one place.
            suggested: Regions in which hands may be; each is read in place of a search.
            spared: Places that are searched less, down to one, since other models are at work.

        Returns:
            The hands, and the row of each in the last image's; -1 for those newly found.
        """
        if self._last is None or not continues(self._last, image):
            self.reset()
        self._last = image
        regions, rows = self._regions[: config.max_hands], self._rows[: config.max_hands]
        guesses = self._guesses(suggested, regions, config)
        room = config.max_hands - len(regions) - len(guesses)
        places = config.search_regions_per_frame
        if budget is not None:
            places = min(places, budget - len(regions))
        places = max(1, places - len(guesses) - spared)
        began_s = time.perf_counter()
        self.seen = seen = SeenPicture(self._clearer.clear(image.bgr), self._movement)
        bgr = seen.bgr
        places = places if room else 0
        searches = self._searches(seen, regions, expected_px, config, places)
        read = Regions.concatenate(regions, guesses)
        hands, palms = self._reader.read_beside(bgr, read, searches)
        rows = np.concatenate([rows, np.full(len(guesses), -1)])
        searched_s = time.perf_counter()
        found = regions_of(palms, config)
        found = drop_known(found, regions)[:room]
        if len(found):
            new_hands, _ = self._reader.read_beside(bgr, found, ())
            hands = Landmarks.concatenate(hands, new_hands)
            rows = np.concatenate([rows, np.full(len(found), -1)])
        hands, again = self._read_again(bgr, hands, rows < 0, read, config)
        is_hand = hands.score >= config.tracking_confidence
        keep = np.flatnonzero(is_hand & _are_shown(hands.points_px, image))
        keep = keep[first_of_each_hand(hands[keep])]
        ended_s = time.perf_counter()
        self.work = PerceptionWork(
            len(searches),
            len(read) + len(found) + again,
            searched_s - began_s,
            ended_s - searched_s,
            ended_s - began_s,
        )
        hands, rows = hands[keep], rows[keep]
        self._follow(hands, config)
        return hands, rows

    def reset(self) -> None:
        """Forget all hands."""
        self._regions = _NO_REGIONS
        self._rows = np.zeros(0, dtype=np.int64)
        self._clearer.reset()
        self._movement.reset()
        self._plan = None
        self._last = None

    def _searches(
        self,
        seen: SeenPicture,
        known: Regions,
        expected_px: FloatArray,
        config: Config,
        count: int,
    ) -> list[Callable[[], Detections]]:
        """The palm searches of this image, to be called beside each other."""
        if count == 0:
            return []
        bgr = seen.tinted_bgr
        size = (bgr.shape[1], bgr.shape[0])
        whole = np.array([0, 0, *size])
        if self._plan is None:
            self._plan = SearchPlan(size)
        likely_px = [_without(boxes_px, known) for boxes_px in (expected_px, seen.moved_px)]
        windows = self._plan.choose(count, *likely_px)
        confidence, shrink = config.detection_confidence, config.downscale_factor
        return [
            partial(self._whole.find, bgr, confidence, shrink=shrink)
            if np.array_equal(window, whole)
            else partial(
                self._pieces.find, bgr, config.piece_confidence, window=_as_window(window)
            )
            for window in windows
        ]

    def _read_again(
        self, bgr: ImageArray, hands: Landmarks, is_new: BoolArray, read: Regions, config: Config
    ) -> tuple[Landmarks, int]:
        """Unsure hands, processed once more; and their number.

        New ones from where the reading puts them: palms of few pixels, and forearms, tell the size
        and turn of their hands but roughly. In a noisy picture also those that were followed or
        suggested, the first ones, read in these regions: smoothed, if they are not too small.
        """
        is_open = hands.score < config.tracking_confidence
        if not is_open.any():
            return hands, 0
        found = regions_from_landmarks(hands.points_px)
        is_near = is_open & is_new & (hands.score >= PROMISING_SCORE)
        hands, again = self._read_better(bgr, hands, is_near & _is_readable(found, config), found)
        is_rough = (is_open & ~is_near)[: len(read)] & (read.side_px >= SMOOTH_FROM_PX)
        if not self._clearer.is_noisy or not is_rough.any():
            return hands, again
        smooth = np.asarray(cv2.GaussianBlur(bgr, (0, 0), SMOOTH_PX), np.uint8)
        hands, smoothed = self._read_better(smooth, hands, is_rough, read)
        return hands, again + smoothed

    def _read_better(
        self, bgr: ImageArray, hands: Landmarks, is_asked: BoolArray, regions: Regions
    ) -> tuple[Landmarks, int]:
        """The hands, those that are asked about read in their regions where that is surer."""
        rows = np.flatnonzero(is_asked)
        rows = rows[np.argsort(-hands.score[rows], kind="stable")][:MOST_AGAIN]
        if len(rows) == 0:
            return hands, 0
        second, _ = self._reader.read_beside(bgr, regions[rows], ())
        better = second.score > hands.score[rows]
        kept = np.arange(len(hands))
        kept[rows[better]] = len(hands) + np.flatnonzero(better)
        return Landmarks.concatenate(hands, second)[kept], len(rows)

    def _guesses(self, suggested: Regions | None, known: Regions, config: Config) -> Regions:
        """The suggested regions that are worth a reading."""
        if not suggested:
            return _NO_REGIONS
        suggested = suggested[_is_readable(suggested, config)]
        return drop_known(suggested, known)[: config.max_hands - len(known)]

    def _follow(self, hands: Landmarks, config: Config) -> None:
        """Remember where to look for these hands in the next image.

        Lowered hands are left alone, as the search leaves them: following everybody's hands takes
        the time in which a raised one would be found.
        """
        regions = regions_from_landmarks(hands.points_px)
        followed = np.flatnonzero(_is_readable(regions, config))
        self._regions, self._rows = regions[followed], followed


def drop_known(found: Regions, known: Regions) -> Regions:
    """The found regions that hold neither a known hand, or a part of one, nor an earlier one."""
    if len(found) == 0:
        return found
    apart_px = np.linalg.norm(found.center_px[:, None] - known.center_px[None], axis=-1)
    is_part = SMALLER_HAND * found.side_px[:, None] < known.side_px
    is_part &= apart_px < known.side_px / 4
    is_new = ~(is_part | (overlap(found, known) > SAME_REGION_OVERLAP)).any(axis=-1)
    found = found[is_new]
    return found[first_of_each(overlap(found, found) > SAME_REGION_OVERLAP, range(len(found)))]


def first_of_each_hand(hands: Landmarks) -> BoolArray:
    """Mask of one row per hand where several regions led to the same one; the surest stays."""
    if len(hands) < 2:
        return np.ones(len(hands), dtype=bool)
    side = regions_from_landmarks(hands.points_px).side_px
    apart = hands.points_px[:, None] - hands.points_px[None]
    distance = np.linalg.norm(apart, axis=-1).mean(axis=-1)
    same = distance < SAME_HAND_DISTANCE * np.minimum(side[:, None], side[None, :])
    same |= _is_inside(hands.points_px, side) | _is_inside(hands.points_px, side).T
    longer = np.maximum(side[:, None], side[None, :]) / SIDE_HANDS
    same |= np.linalg.norm(apart[:, :, WRIST], axis=-1) < SAME_WRIST_DISTANCE * longer
    return first_of_each(same, np.argsort(-hands.score, kind="stable").tolist())


def _are_shown(points_px: FloatArray, image: CameraImage) -> BoolArray:
    """Shape (H,): some of a hand lies in the picture, and it has an extent."""
    is_finite = np.isfinite(points_px).all(axis=(1, 2), keepdims=True)
    points_px = np.where(is_finite, points_px, 0.0)
    low, high = points_px.min(axis=1), points_px.max(axis=1)
    is_within = ((high >= 0.0) & (low <= [image.width, image.height])).all(axis=1)
    return np.asarray(is_within & ((high - low).max(axis=1) >= 1.0))


def _is_inside(points_px: FloatArray, side_px: FloatArray) -> BoolArray:
    """Shape (H, H): the first hand is much smaller and lies within the second.

    A search made for farther hands can take a few fingers for one; a true hand at that place
    would be hidden.
    """
    low, high = points_px.min(axis=1), points_px.max(axis=1)
    center = points_px.mean(axis=1)[:, None]
    within = ((center >= low) & (center <= high)).all(axis=-1)
    return np.asarray(within & (SMALLER_HAND * side_px[:, None] < side_px))


def regions_of(found: Sequence[Detections], config: Config) -> Regions:
    """The regions of palms from several searches, the surest first."""
    if not any(map(len, found)):
        return _NO_REGIONS
    palms = Detections.concatenate(*found)
    palms = palms[np.argsort(-palms.score, kind="stable")]
    regions = regions_from_palms(palms.boxes_px, palms.keypoints_px)
    is_small = regions.side_px < SIDE_HANDS * config.small_hand_px
    is_sure = is_small | (palms.score >= config.detection_confidence)
    return regions[is_sure & _is_readable(regions, config)]


def _is_readable(regions: Regions, config: Config) -> BoolArray:
    """Squares of some size, of hands that the rule could call raised, now or in a moment."""
    finite = np.isfinite(regions.center_px).all(axis=-1) & np.isfinite(regions.side_px)
    finite &= regions.side_px > 1.0
    lean_max_rad = np.radians(config.read_lean_max_deg) + 1e-9
    return np.asarray(finite & (np.abs(regions.rotation_rad) <= lean_max_rad))


def _without(boxes_px: FloatArray, known: Regions) -> FloatArray:
    """The boxes in which no known hand lies."""
    center = known.center_px
    inside = (center >= boxes_px[:, None, :2]) & (center <= boxes_px[:, None, 2:])
    return boxes_px[~inside.all(axis=-1).any(axis=-1)]


def _as_window(box: IntArray) -> Window:
    x_min, y_min, x_max, y_max = box.tolist()
    return x_min, y_min, x_max - x_min, y_max - y_min
