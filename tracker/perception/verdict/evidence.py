"""What speaks for a call, and what against? A few quantities of each hand and of its owner's arm.

Each is a number of about -1 to 1 with a meaning that a person can check on the picture; one that
was not seen is 0, and says nothing. `weights` says how much each counts.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.containers import BoolArray, FloatArray, Hands, IntArray
from tracker.perception.bodies import ELBOWS, HEAD, SHOULDERS, WRISTS, Bodies, Joint
from tracker.perception.verdict.owners import hand_size_px, head_distance_px
from tracker.perception.verdict.raise_rules import MIDDLE_ROOT, MIDDLE_TIP, THUMB_TIP, WRIST

#: Roots, middle joints and tips of the four fingers; the pinky's root.
_ROOTS, _JOINTS, _TIPS, _PINKY_ROOT = [5, 9, 13, 17], [6, 10, 14, 18], [8, 12, 16, 20], 17
_EYES = [Joint.LEFT_EYE, Joint.RIGHT_EYE]
#: How far the crown is above the eyes, against the eyes above the shoulders (guess).
_CROWN = 0.5
#: A hand of this length loses its shape from here on downward, px.
_SMALL_PX = 32.0
#: A body of which so much is not seen, or not believed, may be none. Pose models see people in
#: cables and chairs, but hardly their elbows and wrists: .1 to .6 against .95 and more of people.
_NO_PERSON = 0.3
#: Between this share of that reach and half as much again a palm gets to the head; so high a wrist
#: is above the shoulder.
_ON_HEAD, _ABOVE = 0.5, 0.3
#: Nearer to the head than this counts, in shoulder widths; likewise to the other hand.
_HEAD_REACH, _OTHER_REACH = 0.9, 1.4

#: The names of the quantities, in the order of the columns.
NAMES = (
    "found", "score", "small", "rise", "lean", "fingers", "longest", "spread", "thumb",
    "owned", "unowned", "alone", "low", "palm_low", "high", "fist_low", "overhead", "forearm",
    "head", "palm_on_head", "inside", "together", "doubt", "faint", "apart", "swing",
)  # fmt: skip


class Seen(NamedTuple):
    """What is known of the hands of an image beside their landmarks.

    Attributes:
        is_found: Shape (H,): the landmark model saw the hand; otherwise a forearm ends there.
        owner: Shape (H,): rows of the bodies, or -1.
        is_asked: Shape (H,): its owner was looked for in vain.
        swing: Shape (H,): how much the wrist goes to and fro, 0 to 1.
    """

    is_found: BoolArray
    owner: IntArray
    is_asked: BoolArray
    swing: FloatArray


def gather_evidence(hands: Hands, bodies: Bodies, seen: Seen) -> FloatArray:
    """Every quantity of every hand.

    Args:
        hands: Found ones, and those that continue a forearm.
        bodies: Who is there.
        seen: What else is known.

    Returns:
        Shape (H, F), in the order of `NAMES`.
    """
    shape = _of_shape(hands) * seen.is_found[:, None]
    arm = np.zeros((len(hands), _ARM_COLUMNS))
    rows = np.flatnonzero(seen.owner >= 0)
    if len(rows):
        arm[rows] = _of_arm(hands[rows], bodies[seen.owner[rows]], seen.is_found[rows])
    owned = (seen.owner >= 0).astype(np.float64)
    # A telephone, a cup or an itch bends the hand; a palm that is shown beside the head is a
    # greeting, and one on the head is none.
    palm = np.clip(shape[:, _FINGERS], 0.0, 1.0) * np.clip(shape[:, _RISE], 0.0, 1.0)
    head = arm[:, _HEAD].copy()
    arm[:, _HEAD] = head * (1.0 - palm)
    on_head = palm * np.clip(2.0 * head / _ON_HEAD - 2.0, 0.0, 1.0)
    # An open hand before the shoulder may call, a closed one must be above it.
    fist = np.clip(-shape[:, _FINGERS], 0.0, 1.0)
    fist_low = owned * fist * np.clip(1.0 - arm[:, _HIGH] / _ABOVE, 0.0, 1.0)
    palm_low = arm[:, _LOW] * palm
    arm[:, _LOW] -= palm_low
    places, columns = [_LOW + 1, _HIGH + 1, _HEAD + 1], [palm_low, fist_low, on_head]
    arm = np.insert(arm, places, np.stack(columns, axis=-1), axis=1)
    unowned = ((seen.owner < 0) & seen.is_asked).astype(np.float64)
    # Where no body says more, an open palm that is surely a hand speaks for itself.
    alone = (1.0 - owned) * palm * np.clip(shape[:, _SCORE], 0.0, 1.0)
    return np.column_stack([shape, owned, unowned, alone, arm, seen.swing])


#: Columns of what `_of_shape` and `_of_arm` give.
_SCORE, _RISE, _FINGERS = 1, 3, 5
_LOW, _HIGH, _HEAD, _ARM_COLUMNS = 0, 1, 4, 10


def _of_shape(hands: Hands) -> FloatArray:
    """Shape (H, 9): what the landmarks of a found hand say."""
    points = hands.landmarks_px
    palm = np.maximum(np.linalg.norm(points[:, MIDDLE_ROOT] - points[:, WRIST], axis=-1), 1e-6)
    along = (points[:, MIDDLE_ROOT] - points[:, WRIST]) / palm[:, None]
    reach = np.linalg.norm(points[:, _TIPS] - points[:, [WRIST]], axis=-1)
    bent = np.linalg.norm(points[:, _JOINTS] - points[:, [WRIST]], axis=-1)
    stretched = np.clip((reach - bent) / (0.5 * palm[:, None]), -1.0, 1.0)
    thumb = np.linalg.norm(points[:, THUMB_TIP] - points[:, _PINKY_ROOT], axis=-1) / palm - 1.0
    fingers = stretched.mean(axis=1)
    sure = np.clip(hands.score, 1e-3, 1.0 - 1e-3)
    rise = (points[:, WRIST, 1] - points[:, MIDDLE_TIP, 1]) / palm
    return np.column_stack(
        [
            np.ones(len(hands)),
            np.clip(np.log(sure / (1.0 - sure)) / 4.0, -0.5, 1.5),
            np.clip(np.log2(_SMALL_PX / np.maximum(hand_size_px(hands), 1e-6)), 0.0, 1.5),
            np.clip(rise - 1.0, -1.0, 1.0),
            np.abs(np.arctan2(along[:, 0], -along[:, 1])),
            fingers,
            stretched.max(axis=1, initial=-1.0),
            np.clip(fingers, 0.0, 1.0) * np.clip(thumb, -1.0, 1.0),
            np.clip(-fingers, 0.0, 1.0) * np.clip(thumb, 0.0, 1.0),
        ]
    )


def _of_arm(hands: Hands, owners: Bodies, is_found: BoolArray) -> FloatArray:
    """Shape (H, 10): what the owner's body says; row i of `owners` is the owner of hand i."""
    points, visible, width = owners.points_px, owners.is_visible, owners.shoulder_px
    rows = np.arange(len(hands))
    apart = np.linalg.norm(points[:, WRISTS] - hands.wrist_px[:, None], axis=-1)
    apart = np.where(visible[:, WRISTS], apart, np.inf)
    side = apart.argmin(axis=1)
    wrist, knuckles = hands.wrist_px, hands.landmarks_px[:, MIDDLE_ROOT]
    shoulders = points[:, SHOULDERS].mean(axis=1)
    rise = (shoulders[:, 1] - wrist[:, 1]) / width
    heads_y = np.where(visible[:, HEAD], points[:, HEAD, 1], np.inf).min(axis=1)
    above = np.where(np.isfinite(heads_y), (heads_y - wrist[:, 1]) / width, 0.0)
    elbow = points[rows, np.array(ELBOWS)[side]]
    forearm = wrist - elbow
    upright = -forearm[:, 1] / np.maximum(np.linalg.norm(forearm, axis=-1), 1.0)
    upright = np.where(visible[rows, np.array(ELBOWS)[side]], upright, 0.0)
    tip = hands.landmarks_px[:, MIDDLE_TIP]
    # Of a hand that was not found nothing but the wrist is known.
    ends = (np.where(is_found[:, None], end, wrist) for end in (wrist, knuckles, tip))
    crown = _crowns_px(owners)
    to_head = [
        np.fmin(head_distance_px(owners, end), np.linalg.norm(end - crown, axis=-1))
        for end in ends
    ]
    head = np.min(to_head, axis=0) / width
    aside = np.abs(wrist[:, 0] - shoulders[:, 0]) / width
    other = points[rows, np.array(WRISTS)[1 - side]]
    pair = np.linalg.norm(other - wrist, axis=-1) / width
    pair = np.where(visible[rows, np.array(WRISTS)[1 - side]], pair, np.inf)
    both = owners.visibility[:, [*ELBOWS, *WRISTS]].mean(axis=1)
    trunk = owners.visibility[:, [Joint.NOSE, *SHOULDERS]].mean(axis=1)
    mismatch = np.where(is_found, np.minimum(apart.min(axis=1) / width, 1.0), 0.0)
    return np.column_stack(
        [
            np.clip(-rise, 0.0, 1.0),
            np.clip(rise, 0.0, 1.0),
            np.clip(above, 0.0, 1.0),
            upright,
            np.clip(1.0 - head / _HEAD_REACH, 0.0, 1.0),
            np.clip(1.0 - 2.0 * aside, 0.0, 1.0),
            np.clip(1.0 - pair / _OTHER_REACH, 0.0, 1.0),
            np.clip((1.0 - trunk * owners.score) / _NO_PERSON, 0.0, 1.0),
            np.where(is_found, 0.0, np.clip((1.0 - both * owners.score) / _NO_PERSON, 0.0, 1.0)),
            mismatch,
        ]
    )


def _crowns_px(bodies: Bodies) -> FloatArray:
    """Shape (P, 2): the tops of the heads, where people scratch; NaN where that is not known."""
    joints = [*_EYES, *SHOULDERS]
    eyes, shoulders = (bodies.points_px[:, rows].mean(axis=1) for rows in (_EYES, SHOULDERS))
    is_seen = bodies.is_visible[:, joints].all(axis=1, keepdims=True)
    return np.where(is_seen, eyes + _CROWN * (eyes - shoulders), np.nan)
