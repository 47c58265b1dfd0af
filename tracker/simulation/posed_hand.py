"""Where are a hand's landmarks when its joints bend? A right hand of rigid bones, many at once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.containers import FloatArray

#: Adults' bones from the roots of index, middle, ring and little finger to their tips, in mm.
#: Source: Buryanov and Kotiuk, "Proportions of hand segments", Int. J. Morphol. 28(3), 2010.
BONES_MM = np.array(
    [(39.8, 22.4, 15.8), (44.6, 26.3, 17.4), (41.4, 25.7, 17.3), (32.7, 18.1, 16.0)]
)
#: The thumb's metacarpal and two bones, likewise.
THUMB_BONES_MM = np.array([46.2, 31.6, 21.7])
#: Roots of the thumb and of the four fingers from the wrist: the metacarpals of the same source
#: behind some 25 mm of carpus, fanned out as in an open hand (guess).
ROOTS_MM = np.array(
    [(19.0, 22.0, 6.0), (24.0, 90.0, 0.0), (2.0, 90.0, -2.0), (-18.0, 84.0, 0.0),
     (-35.0, 75.0, 4.0)]
)  # fmt: skip
#: From the wrist to the tip of the stretched middle finger.
LENGTH_MM = float(ROOTS_MM[2, 1] + BONES_MM[1].sum())
#: Where the fingers point in an open hand, from straight ahead toward the thumb, in radians.
FAN_RAD = np.radians([6.0, 0.0, -7.0, -14.0])


class HandPose(NamedTuple):
    """How N hands are held; all angles in radians.

    Attributes:
        bend: Shape (N, 4, 3): root, middle and end joint of index to little finger, 0 is straight.
        spread: Shape (N, 4): of the fingers, beyond `FAN_RAD`, positive toward the thumb.
        thumb: Shape (N, 4): its metacarpal aside from the fingers' direction and out of the palm,
            then the bends of its two joints.
    """

    bend: FloatArray
    spread: FloatArray
    thumb: FloatArray


def hand_points(pose: HandPose, stretch: FloatArray | None = None) -> FloatArray:
    """Landmarks of right hands in MediaPipe's order, shape (N, 21, 3), in hand lengths.

    The palm looks along z at whoever sees x to the right, toward the thumb, and y up, along the
    stretched fingers; the wrist is the origin.

    Args:
        pose: Of N hands.
        stretch: Shape (N, 20): of each bone, in the order of the landmarks that end it; None
            is 1 for all.
    """
    count = len(pose.bend)
    stretch = np.ones((count, 20)) if stretch is None else stretch
    points = np.zeros((count, 21, 3))
    points[:, 1:5] = _thumb_mm(pose.thumb, stretch[:, 0:4])
    across = FAN_RAD + pose.spread
    for finger in range(4):
        first = 5 + 4 * finger
        ahead = np.stack([np.sin(across[:, finger]), np.cos(across[:, finger])], axis=-1)
        place = ROOTS_MM[1 + finger] * stretch[:, first - 1, None]
        points[:, first] = place
        bent = np.cumsum(pose.bend[:, finger], axis=-1)
        for joint in range(3):
            bone_mm = BONES_MM[finger, joint] * stretch[:, first + joint, None]
            along = np.concatenate(
                [np.cos(bent[:, [joint]]) * ahead, np.sin(bent[:, [joint]])], axis=-1
            )
            place = place + bone_mm * along
            points[:, first + joint + 1] = place
    return points / LENGTH_MM


def _thumb_mm(thumb: FloatArray, stretch: FloatArray) -> FloatArray:
    """Shape (N, 4, 3): root, joints and tip."""
    aside, out, *_ = thumb.T
    along = np.stack(
        [np.sin(aside) * np.cos(out), np.cos(aside) * np.cos(out), np.sin(out)], axis=-1
    )
    # It bends across the palm, and the more toward the palm the less it stands out of it.
    inward = np.stack([-np.cos(aside), np.sin(aside), np.zeros(len(aside))], axis=-1)
    places = [ROOTS_MM[0] * stretch[:, [0]]]
    bent = np.concatenate([np.zeros((len(aside), 1)), np.cumsum(thumb[:, 2:], axis=-1)], axis=-1)
    for joint in range(3):
        turned = np.cos(bent[:, [joint]]) * along + np.sin(bent[:, [joint]]) * inward
        places.append(places[-1] + THUMB_BONES_MM[joint] * stretch[:, [joint + 1]] * turned)
    return np.stack(places, axis=1)
