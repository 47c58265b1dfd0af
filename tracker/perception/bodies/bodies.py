"""Where are people's heads, shoulders and arms? Bodies as any pose model tells them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property
from typing import Annotated

import numpy as np

from tracker.containers import BoolArray, FloatArray
from tracker.containers.arrays import sealed
from tracker.containers.rows import Column, Rows, trusted
from tracker.perception.regions import first_of_each

#: Points seen with less are taken for unknown; a guess between 0.3, usual for COCO's models, and
#: MediaPipe's 0.5.
VISIBLE_FROM = 0.4
#: Grown people's shoulders, joint to joint, against their trunk from shoulders to hips: seen from
#: the side a person keeps the trunk's length (guess from anthropometric tables).
_SHOULDERS_PER_TRUNK = 0.7
#: A nose so far above the shoulders, in their widths, is where noses are: of 3,000 looks at drawn
#: people who sit or stand 99 in 100 have it above 0.32, and people who bow keep most of it.
_NOSE_RISE = 0.2
#: Bodies whose points are closer than this, on average, are one person's (guess).
_SAME_BODY_SHOULDERS = 0.5

#: Of somebody who faces the camera the shoulders are about as far from the nose, one at least so
#: much of the other (guess).
_EVEN_SHOULDERS = 0.5
#: How far the knees are below the hips, in lengths of the trunk: of people who stand, and of those
#: who sit, whose thighs are level and point anywhere (guess from anthropometric tables).
_KNEES_OF_STANDING, _KNEES_OF_SEATED = 0.75, 0.4
#: Wrists so far below the shoulders, in their widths, are about as high.
_ABOUT_LEVEL = 0.2


class Joint(IntEnum):
    """The points of a body, in the order of the COCO data set; left is the person's own left."""

    NOSE = 0
    LEFT_EYE = 1
    RIGHT_EYE = 2
    LEFT_EAR = 3
    RIGHT_EAR = 4
    LEFT_SHOULDER = 5
    RIGHT_SHOULDER = 6
    LEFT_ELBOW = 7
    RIGHT_ELBOW = 8
    LEFT_WRIST = 9
    RIGHT_WRIST = 10
    LEFT_HIP = 11
    RIGHT_HIP = 12
    LEFT_KNEE = 13
    RIGHT_KNEE = 14
    LEFT_ANKLE = 15
    RIGHT_ANKLE = 16


HEAD = [Joint.NOSE, Joint.LEFT_EYE, Joint.RIGHT_EYE, Joint.LEFT_EAR, Joint.RIGHT_EAR]
SHOULDERS = [Joint.LEFT_SHOULDER, Joint.RIGHT_SHOULDER]
ELBOWS = [Joint.LEFT_ELBOW, Joint.RIGHT_ELBOW]
WRISTS = [Joint.LEFT_WRIST, Joint.RIGHT_WRIST]
HIPS = [Joint.LEFT_HIP, Joint.RIGHT_HIP]
KNEES = [Joint.LEFT_KNEE, Joint.RIGHT_KNEE]


@dataclass(frozen=True, eq=False)
class Bodies(Rows):
    """People found in one picture; row i of each array is the same person.

    Attributes:
        points_px: Shape (P, 17, 2), in the order of `Joint`: x to the right, y down, in the full
            image.
        visibility: Shape (P, 17): how sure the model is of each point, in [0, 1].
        score: Shape (P,): how sure it is of the person, in [0, 1].
        age_s: Shape (P,): how long ago the person was seen there; 0 for this very image.
        alignment_px: Shape (P, 2, 2): where to look next; see `regions_from_alignment`. None
            means NaN, for models that do not tell.

    Raises:
        ShapeError: The arrays disagree in shape.
    """

    points_px: Annotated[FloatArray, Column((17, 2))]
    visibility: Annotated[FloatArray, Column((17,))]
    score: FloatArray
    age_s: FloatArray
    alignment_px: Annotated[FloatArray, Column((2, 2), missing=np.nan)] = None  # type: ignore[assignment]  # NaN takes its place

    @staticmethod
    def seen_now(points_px: FloatArray, visibility: FloatArray, score: FloatArray) -> Bodies:
        """Bodies of this very image."""
        return Bodies(points_px, visibility, score, np.zeros(len(score)))

    def grown_older(self, passed_s: float) -> Bodies:
        """The same people, as long after."""
        # With what was worked out of them: only their age has changed.
        return trusted(Bodies, **{**self.__dict__, "age_s": sealed(self.age_s + passed_s)})

    @property
    def arms_up(self) -> BoolArray:
        """Shape (P, 2): arms whose wrist is seen about as high as the shoulders, or higher."""
        seen = self.is_visible[:, WRISTS] & self.is_visible[:, SHOULDERS]
        rise_px = self.points_px[:, SHOULDERS, 1] - self.points_px[:, WRISTS, 1]
        return np.asarray(seen & (rise_px > -_ABOUT_LEVEL * self.shoulder_px[:, None]))

    @cached_property
    def is_visible(self) -> BoolArray:
        """Shape (P, 17): points that may be relied upon."""
        finite = np.isfinite(self.points_px).all(axis=-1)
        return np.asarray(finite & (self.visibility >= VISIBLE_FROM))

    @property
    def is_misread(self) -> BoolArray:
        """Shape (P,): bodies with the nose at the shoulders, as seen in half of a person."""
        joints = [Joint.NOSE, *SHOULDERS]
        rise_px = self.points_px[:, SHOULDERS, 1].mean(axis=1) - self.points_px[:, Joint.NOSE, 1]
        seen = self.is_visible[:, joints].all(axis=1)
        return np.asarray(seen & (rise_px < _NOSE_RISE * self.shoulder_px))

    @cached_property
    def torso_px(self) -> FloatArray:
        """Shape (P, 2): the middle of shoulders and hips, of the shoulders where no hip is seen.

        NaN where a shoulder is missing.
        """
        shoulders, hips = self._shoulders_px, self._middle_of(HIPS)
        return np.where(np.isnan(hips), shoulders, (shoulders + hips) / 2)

    @cached_property
    def shoulder_px(self) -> FloatArray:
        """Shape (P,): the shoulders' width, the yardstick of a body; NaN where one is missing.

        One that the picture's edge cuts off is where the model supposes it, if that is about as
        far from the head as the other. Somebody who stands sideways is measured by the trunk
        instead, where hips are seen.
        """
        shoulders, hips = self._shoulders_px, self._middle_of(HIPS)
        width = 2.0 * np.linalg.norm(self.points_px[:, SHOULDERS[0]] - shoulders, axis=-1)
        trunk = np.linalg.norm(hips - shoulders, axis=-1)
        wider = np.fmax(width, _SHOULDERS_PER_TRUNK * trunk)
        return np.where(wider > 0.0, wider, np.nan)

    @property
    def seated(self) -> FloatArray:
        """Shape (P,), in [0, 1]: whether somebody sits; NaN where hips or knees are not seen."""
        shoulders = self._shoulders_px
        hips, knees = self._middle_of(HIPS), self._middle_of(KNEES)
        trunk = np.linalg.norm(hips - shoulders, axis=-1)
        fall = (knees - hips)[:, 1] / np.where(trunk > 0.0, trunk, np.nan)
        share = (_KNEES_OF_STANDING - fall) / (_KNEES_OF_STANDING - _KNEES_OF_SEATED)
        return np.asarray(np.clip(share, 0.0, 1.0))

    @cached_property
    def _shoulders_px(self) -> FloatArray:
        """Shape (P, 2): the middle of both shoulders, NaN where one is missing."""
        seen = self.is_visible
        left, right = (self.points_px[:, SHOULDERS, 0] - self.points_px[:, [Joint.NOSE], 0]).T
        is_even = np.minimum(left, -right) > _EVEN_SHOULDERS * np.maximum(left, -right)
        is_one_supposed = seen[:, SHOULDERS].any(axis=1) & seen[:, Joint.NOSE] & is_even
        return self._middle_of(SHOULDERS, is_one_supposed)

    def _middle_of(self, joints: list[Joint], is_supposed: BoolArray | bool = False) -> FloatArray:
        is_known = np.asarray(self.is_visible[:, joints].all(axis=1) | is_supposed)
        return np.where(is_known[:, None], self.points_px[:, joints].mean(axis=1), np.nan)


def same_people(first: Bodies, second: Bodies) -> BoolArray:
    """Pairs of bodies that are one person's: the points that both show lie close together.

    Returns:
        Shape (F, S).
    """
    apart = np.linalg.norm(first.points_px[:, None] - second.points_px[None], axis=-1)
    both = first.is_visible[:, None] & second.is_visible[None]
    distance = np.where(both, apart, 0.0).sum(axis=-1) / np.maximum(both.sum(axis=-1), 1)
    width = np.fmin(first.shoulder_px[:, None], second.shoulder_px[None])
    return np.asarray(both.any(axis=-1) & (distance < _SAME_BODY_SHOULDERS * width))


def one_row_each(bodies: Bodies) -> BoolArray:
    """Mask of the rows that stand for a person: of several the freshest, then the surest."""
    same = same_people(bodies, bodies)
    return first_of_each(same, np.lexsort((-bodies.score, bodies.age_s)).tolist())
