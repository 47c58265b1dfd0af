"""Where does the palm search look next? The places of the picture, by need.

A hand at three meters is lost in a whole picture squeezed to the model's input, so pieces of the
picture are searched as well: a rotation of overlapping tiles, and windows around people who are
expected somewhere. A few of them are searched in each image; the longer ago one was, the greater
its need, and where a hand is likelier its need grows faster. The whole picture has its own period.
"""

from __future__ import annotations

from collections import deque

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray
from tracker.perception.regions import box_overlap, first_of_each

#: A tile's side, in short sides of the picture: at 640 x 480 a tile of 240 px, in which a hand at
#: three meters is 28 px long.
TILE_SIDE = 0.5
#: The same for hands at four meters, which only stand around the horizon: the tiles' side, and
#: where their rows begin, in heights of the picture (a camera that is about level).
FAR_TILE_SIDE, FAR_TILE_TOPS = 1 / 3, (1 / 6, 1 / 3)
#: The most that neighboring tiles are apart, in their sides. A hand in the overlap is seen whole
#: by one of them; people stand side by side, so that columns lie closer than rows. Six tiles
#: instead of the fifteen that this makes of 640 x 480 lost a tenth of the hands.
TILE_STEPS = (0.42, 0.5)
#: How many times as fast as a tile's the need of a place grows; where somebody is expected and
#: something moved, an arm may have gone up.
EXPECTED_WEIGHT, MOVED_WEIGHT = 10.0, 2.0
#: The window around something that moved: its least side, in short sides of the picture, in which
#: a hand at five meters is as large as one at three is in a tile; and its side in extents of what
#: moved.
MOVED_SIDE, MOVED_MARGIN = 1 / 4, 1.5
#: For so many images after something moved a hand is likelier there, in so many places at most:
#: the latest ones.
MOVED_IMAGES, MOVED_PLACES = 20, 6
#: The whole picture is searched in every so many images: a hand near by, which it shows, is found
#: in time to be called raised in the third image.
WHOLE_PERIOD = 2
#: Windows that overlap more than this are the same place; neighboring tiles overlap by 0.41.
SAME_PLACE_OVERLAP = 0.5
#: So many images are remembered for expected places. Older ones and those where nobody has looked
#: yet need it alike: windows that wander, with a robot that turns, must not starve the rest.
NEW_AGE = 12
#: A window around somebody sways by up to this share of its width to either side from look to
#: look: a hand far from the body is not cut off each time, and what one cut hides another shows.
SWAY = 0.2
_GOLDEN = 0.618  # steps that spread evenly, whoever's turn it is


class SearchPlan:
    """The places of pictures of one size, (width, height); remembers where was looked."""

    def __init__(self, image_size: tuple[int, int]) -> None:
        self._size = image_size
        self._rotation = rotation_windows(*image_size)
        self._turn = self._looks = 0
        # As if the rotation had been going on: ages that are all alike would come due all at once.
        self._rotation_turn = np.arange(-len(self._rotation), 0)
        self._lately: deque[tuple[int, FloatArray]] = deque()
        self._moved_px, self._moved_turn = np.zeros((0, 4)), np.zeros(0)

    def choose(self, count: int, expected_px: FloatArray, moved_px: FloatArray) -> IntArray:
        """The places to search in the next image; every call is one image.

        Args:
            count: How many.
            expected_px: Shape (E, 4): x_min, y_min, x_max, y_max of windows where raised hands are
                expected; each is a place of its own.
            moved_px: Shape (M, 4): boxes in which something moved; they draw attention to the
                places that hold their centers, and for a while the window around each is a place
                of its own: a hand that is up has come there.

        Returns:
            Shape (K, 4): windows, the neediest first; K is `count` or, if fewer, all places.
        """
        self._turn += 1
        while self._lately and self._lately[0][0] <= self._turn - NEW_AGE:
            self._lately.popleft()
        tiles = len(self._rotation)
        self._remember(moved_windows(moved_px, self._size))
        expected_px = clip_boxes(expected_px, self._size)
        places = np.concatenate([self._rotation, expected_px, self._moved_px])
        weight = np.where(_holds_center(places, moved_px), MOVED_WEIGHT, 1.0)
        weight[tiles:] *= EXPECTED_WEIGHT
        weight[0] = 0.0  # it has a period of its own
        is_due = self._turn - self._rotation_turn[0] >= WHOLE_PERIOD
        chosen: list[int] = []
        age = np.concatenate([self._turn - self._rotation_turn, self._ages(places[tiles:])])
        while len(chosen) < min(count, len(places)):
            need = weight * age
            need[chosen] = -1.0
            place = 0 if is_due and not chosen else int(np.argmax(need))
            chosen.append(place)
            self._lately.append((self._turn, places[place]))
            if place < tiles:
                self._rotation_turn[place] = self._turn
            is_same = box_overlap(places[[place]], places[tiles:])[0] > SAME_PLACE_OVERLAP
            age[tiles:][is_same] = 0.0
        windows = places[chosen]
        around = np.flatnonzero(np.array(chosen) >= tiles)
        windows[around] += self._sway(windows[around])
        whole_pixels: IntArray = clip_boxes(windows, self._size).round().astype(np.int64)
        return whole_pixels

    def _remember(self, windows: FloatArray) -> None:
        """Keep windows in which something moved, the latest first and each place once."""
        windows = np.concatenate([windows, self._moved_px])
        turn = np.append(np.full(len(windows) - len(self._moved_px), self._turn), self._moved_turn)
        keep = turn > self._turn - MOVED_IMAGES
        keep &= first_of_each(box_overlap(windows, windows) > SAME_PLACE_OVERLAP, range(len(turn)))
        latest = np.flatnonzero(keep)[:MOVED_PLACES]
        self._moved_px, self._moved_turn = windows[latest], turn[latest]

    def _sway(self, windows: FloatArray) -> FloatArray:
        """How far the windows around people move this time, shape (W, 4)."""
        step = (self._looks + np.arange(len(windows))) * _GOLDEN % 1.0
        self._looks += len(windows)
        shift = (2.0 * step - 1.0) * SWAY * (windows[:, 2] - windows[:, 0])
        return shift[:, None] * [1.0, 0.0, 1.0, 0.0]

    def _ages(self, places: FloatArray) -> FloatArray:
        """Shape (P,): images since any window at the same place was searched."""
        if not self._lately:
            return np.full(len(places), float(NEW_AGE))
        turns = np.array([turn for turn, _ in self._lately])
        windows = np.stack([window for _, window in self._lately])
        is_same = box_overlap(places, windows) > SAME_PLACE_OVERLAP
        age = np.where(is_same, self._turn - turns, NEW_AGE)
        return np.asarray(age.min(axis=1), dtype=np.float64)


def rotation_windows(width: int, height: int) -> FloatArray:
    """The whole picture, the tiles that cover it row by row, and smaller ones around the horizon.

    Shape (R, 4): x_min, y_min, x_max, y_max; R is 1 + 15 + 18 for 640 x 480.
    """
    whole = [0.0, 0.0, float(width), float(height)]
    side, far_side = (share * min(width, height) for share in (TILE_SIDE, FAR_TILE_SIDE))
    column_step, row_step = TILE_STEPS
    tops = _spread(height, side, row_step)
    far_tops = height * np.array(FAR_TILE_TOPS)
    return np.concatenate(
        [
            [whole],
            _tiles(_spread(width, side, column_step), tops, side),
            _tiles(_spread(width, far_side, column_step), far_tops, far_side),
        ]
    )


def moved_windows(moved_px: FloatArray, image_size: tuple[int, int]) -> FloatArray:
    """Windows in which the hand is if what moved was an arm that went up.

    Args:
        moved_px: Shape (M, 4): boxes in which something moved, from one image to the next.
        image_size: Width and height in pixels.

    Returns:
        Shape (M, 4): squares around the upper ends of the boxes, cut to the picture.
    """
    extent = (moved_px[:, 2:] - moved_px[:, :2]).max(axis=1, initial=0.0)
    half = np.maximum(MOVED_MARGIN * extent, MOVED_SIDE * min(image_size)) / 2
    upper = np.stack([moved_px[:, [0, 2]].mean(axis=1), moved_px[:, 1]], axis=-1)
    return clip_boxes(
        np.concatenate([upper - half[:, None], upper + half[:, None]], axis=-1), image_size
    )


def _spread(size_px: float, side_px: float, step: float) -> FloatArray:
    """Where tiles begin that cover a length and lie no farther apart than `step` sides."""
    count = 1 + int(np.ceil((size_px - side_px) / (step * side_px)))
    return np.linspace(0.0, size_px - side_px, count)


def _tiles(lefts: FloatArray, tops: FloatArray, side_px: float) -> FloatArray:
    left, top = (grid.ravel() for grid in np.meshgrid(lefts, tops))
    return np.stack([left, top, left + side_px, top + side_px], axis=-1)


def clip_boxes(boxes_px: FloatArray, image_size: tuple[int, int]) -> FloatArray:
    """The part of each box, (B, 4), that lies in the picture; those of which none does go."""
    clipped = np.clip(boxes_px, 0.0, np.tile(np.asarray(image_size, dtype=float), 2))
    return clipped[np.all(clipped[:, 2:] - clipped[:, :2] >= 1.0, axis=1)]


def _holds_center(windows: FloatArray, boxes: FloatArray) -> BoolArray:
    center = (boxes[:, :2] + boxes[:, 2:]) / 2
    inside = (center >= windows[:, None, :2]) & (center <= windows[:, None, 2:])
    return np.asarray(inside.all(axis=-1).any(axis=-1), dtype=np.bool_)
