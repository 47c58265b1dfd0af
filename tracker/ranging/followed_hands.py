"""Which hand of this image is which of the last one? Evidence is added up over images.

How long a palm looks, and where its thumb points, is uncertain by the noise of a few pixels, which
is new in each image: means over a second tell more. Any detector will do; hands are recognized by
their direction and size.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np
from scipy.optimize import linear_sum_assignment

from tracker.containers import FloatArray, IntArray
from tracker.containers.rows import Rows
from tracker.geometry import normalize_angle

#: No track has this id.
NOBODY = 0
#: Means forget with this time constant: somebody who walks is a meter nearer after a second.
_MEMORY_S = 1.0
#: A hand that no image has shown for so long is another one when it comes back.
_LOST_S = 1.0
#: ... and may be a neighbor's after so long: two hands went down and up (guess).
_OWNED_S = 0.35
#: The same hand turns no farther between two images, and in each second without one (guesses) ...
_TURN_RAD, _TURN_RAD_PER_S = 0.1, 0.5
#: ... and looks no larger or smaller than by this factor.
_GROWTH = 1.6


@dataclass(frozen=True, eq=False)
class HandMeans(Rows):
    """What is known of hands; row i of each array is the same hand.

    Attributes:
        heading_rad: Shape (H,): direction of the hand in the fixed frame, in the last image.
        seen_ns: Shape (H,): stamp of the last image.
        palm_px2: Shape (H,): squared length of the palm, mean.
        breadth_px2: Shape (H,): squared length told by the palm's breadth, mean.
        side: Shape (H,): `owner_side`, mean.
        torso_rad: Shape (H,): from the hand to its owner's torso, mean; NaN where no pose told it.
        images: Shape (H,): of how many images the means are worth, at least 1.
        owner_id: Shape (H,): the track that owned it in the last image, or `NOBODY`.
    """

    heading_rad: FloatArray
    seen_ns: IntArray
    palm_px2: FloatArray
    breadth_px2: FloatArray
    side: FloatArray
    torso_rad: FloatArray
    images: FloatArray
    owner_id: IntArray


class FollowedHands:
    """Hands from image to image."""

    def __init__(self) -> None:
        self._known = HandMeans.none()

    def reset(self) -> None:
        """Forget them."""
        self._known = HandMeans.none()

    def follow(self, seen: HandMeans, stamp_ns: int) -> HandMeans:
        """Take in one image's hands.

        Args:
            seen: As this image alone shows them.
            stamp_ns: The image's.

        Returns:
            The same hands, with the means over all images that showed them.
        """
        lapse_s = (stamp_ns - self._known.seen_ns) / 1e9
        known = self._known[(lapse_s >= 0.0) & (lapse_s <= _LOST_S)]
        row, was = _recognized(seen, known, stamp_ns)
        before, now = known[was], seen[row]
        forgets = -np.expm1(-(stamp_ns - before.seen_ns) / 1e9 / _MEMORY_S)
        gain = np.maximum(1.0 / (before.images + 1.0), forgets)
        means = {"images": 1.0 / gain}
        for name in ("palm_px2", "breadth_px2", "side", "torso_rad"):
            last, new = getattr(before, name), getattr(now, name)
            mean = last + gain * (new - last)
            means[name] = np.where(np.isnan(mean), np.where(np.isnan(last), new, last), mean)
        columns = {item.name: getattr(seen, item.name).copy() for item in fields(seen)}
        is_followed = stamp_ns - before.seen_ns <= _OWNED_S * 1e9
        columns["owner_id"][row] = np.where(is_followed, before.owner_id, NOBODY)
        for name, mean in means.items():
            columns[name][row] = mean
        result = HandMeans(**columns)
        self._known = HandMeans.concatenate(
            result, known[np.setdiff1d(np.arange(len(known)), was)]
        )
        return result

    def owned_by(self, track_id: IntArray) -> None:
        """Remember whose the hands of the last image are, shape (H,)."""
        owner_id = self._known.owner_id.copy()
        owner_id[: len(track_id)] = track_id
        self._known = replace(self._known, owner_id=owner_id)


def _recognized(seen: HandMeans, known: HandMeans, stamp_ns: int) -> tuple[IntArray, IntArray]:
    """Rows of `seen` and of `known` that are one hand."""
    turn_rad = np.abs(normalize_angle(seen.heading_rad[:, None] - known.heading_rad))
    turn = turn_rad / (_TURN_RAD + _TURN_RAD_PER_S * (stamp_ns - known.seen_ns) / 1e9)
    growth = np.abs(np.log(seen.palm_px2[:, None] / known.palm_px2)) / (2.0 * np.log(_GROWTH))
    unlike = np.nan_to_num(np.hypot(turn, growth), nan=np.inf)
    row, was = linear_sum_assignment(np.minimum(unlike, 2.0))
    is_same = unlike[row, was] <= 1.0
    return row[is_same], was[is_same]
