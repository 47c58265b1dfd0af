"""Quantities for and against a call, of each hand and of its owner's arm.

Each is a number of about -1 to 1 with a meaning that a person can check on the picture; one that
was not seen is 0, and says nothing. `weights` says how much each counts.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.containers import BoolArray, FloatArray, Hands, IntArray
from tracker.perception.bodies.bodies import ELBOWS, HEAD, SHOULDERS, WRISTS, Bodies, Joint
from tracker.perception.bodies.owners import hand_size_px, head_distance_px
from tracker.perception.verdict.raise_rules import MIDDLE_ROOT, MIDDLE_TIP, THUMB_TIP, WRIST
from tracker.perception.verdict.weights import NAMES

#: Middle joints and tips of the four fingers; the pinky's root.
_JOINTS, _TIPS, _PINKY_ROOT = [6, 10, 14, 18], [8, 12, 16, 20], 17
_EYES = [Joint.LEFT_EYE, Joint.RIGHT_EYE]
#: How far the crown is above the eyes, against the eyes above the shoulders (guess).
_CROWN = 0.5
#: A body of which so much is not seen, or not believed, may be none. Pose models see people in
#: cables and chairs, but hardly their elbows and wrists: .1 to .6 against .95 and more of people.
_NO_PERSON = 0.3
#: Between these shares of that reach a closed hand, and a palm, gets to the head: nearer than the
#: second are telephones, farther than the first are calls. So high a wrist is above the shoulder.
_FIST_AT_HEAD, _PALM_AT_HEAD, _ABOVE = np.array([0.3, 0.7]), np.array([0.55, 0.75]), 0.3
#: Of hands so short the landmarks do not tell open from closed; of those twice as long they do.
_BLURRED_PX = 10.0
#: Nearer to the head than this counts, in shoulder widths; likewise to the other hand.
_HEAD_REACH, _OTHER_REACH = 0.9, 1.4


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
    """Every quantity of every hand, found or at the end of a forearm.

    Shape (H, F), in the order of `weights.NAMES`.
    """
    if len(hands) == 0:
        return np.zeros((0, len(NAMES)))
    owned, found = (flags.astype(np.float64) for flags in (seen.owner >= 0, seen.is_found))
    shape = {name: found * column for name, column in _shapes_of(hands).items()}
    arm = {name: np.zeros(len(hands)) for name in _ARM}
    rows = np.flatnonzero(seen.owner >= 0)
    if len(rows):
        told = _arms_of(hands[rows], bodies[seen.owner[rows]], seen.is_found[rows])
        for name in _ARM:
            arm[name][rows] = told[name]
    fingers, thumb = shape.pop("fingers"), shape.pop("thumb")
    sharp = found * np.clip(hand_size_px(hands) / _BLURRED_PX - 1.0, 0.0, 1.0)
    stretched, bent = np.clip(fingers, 0.0, 1.0), np.clip(-fingers, 0.0, 1.0) * sharp
    palm = stretched * np.clip(shape["rise"], 0.0, 1.0)
    # What cannot be told may be a palm.
    maybe_palm = np.maximum(palm, 0.5 * found * (1.0 - sharp))
    is_alone = arm["forearm"] == 0.0
    # Talking hands move to and fro as well, but low and half open.
    upright_palm = palm * np.where(is_alone, 1.0, arm["forearm"])
    wave = seen.swing * np.clip(np.maximum(2.0 * arm["high"], upright_palm), 0.0, 1.0)
    # A telephone, a cup or an itch bends the hand; a palm that is shown beside the head is a
    # greeting, one on the head is none, unless it passes there as it waves.
    at_head = _at_head(arm["head"], maybe_palm) * (1.0 - palm * wave)
    low = arm["low"]
    columns = {
        **shape,
        **arm,
        "found": found,
        "spread": stretched * thumb,
        # A thumb that stands off a closed hand is a sign of another kind.
        "thumb": bent * np.clip(thumb, 0.0, 1.0),
        "owned": owned,
        "unowned": (1.0 - owned) * seen.is_asked,
        # Where no arm says more, an open palm that is surely a hand speaks for itself.
        "alone": is_alone * palm * np.clip(shape["score"], 0.0, 1.0),
        # An open hand before the shoulder may call, a closed one must be above it.
        "low": low * (1.0 - maybe_palm),
        "palm_low": low * maybe_palm,
        "fist_low": owned * bent * np.clip(1.0 - arm["high"] / _ABOVE, 0.0, 1.0),
        "head": at_head,
        "swing": wave,
    }
    return np.stack([columns[name] for name in NAMES], axis=-1)


def _at_head(head: FloatArray, palm: FloatArray) -> FloatArray:
    """Shape (H,): how surely hands are at the head, those that are palms nearer than fists."""
    far, near = (_FIST_AT_HEAD + palm[:, None] * (_PALM_AT_HEAD - _FIST_AT_HEAD)).T
    return np.asarray(np.clip((head - far) / (near - far), 0.0, 1.0))


def _shapes_of(hands: Hands) -> dict[str, FloatArray]:
    """What the landmarks of found hands say, each of shape (H,)."""
    points = hands.landmarks_px
    palm = np.maximum(np.linalg.norm(points[:, MIDDLE_ROOT] - points[:, WRIST], axis=-1), 1e-6)
    along = points[:, MIDDLE_ROOT] - points[:, WRIST]
    tips, joints = (
        np.linalg.norm(points[:, rows] - points[:, [WRIST]], axis=-1) for rows in (_TIPS, _JOINTS)
    )
    thumb = np.linalg.norm(points[:, THUMB_TIP] - points[:, _PINKY_ROOT], axis=-1) / palm
    sure = np.clip(hands.score, 1e-3, 1.0 - 1e-3)
    rise = (points[:, WRIST, 1] - points[:, MIDDLE_TIP, 1]) / palm
    return {
        "score": np.clip(np.log(sure / (1.0 - sure)) / 4.0, -0.5, 1.5),
        "rise": np.clip(rise - 1.0, -1.0, 1.0),
        "lean": np.abs(np.arctan2(along[:, 0], -along[:, 1])),
        "fingers": np.clip((tips - joints) / (0.5 * palm[:, None]), -1.0, 1.0).mean(axis=1),
        "thumb": np.clip(thumb - 1.0, -1.0, 1.0),
    }


_ARM = (
    "low", "high", "overhead", "forearm", "head", "inside", "together", "doubt", "faint", "apart",
)  # fmt: skip


def _arms_of(hands: Hands, owners: Bodies, is_found: BoolArray) -> dict[str, FloatArray]:
    """What the owners' bodies say, each of shape (H,); owner i is that of hand i."""
    points, visible, width = owners.points_px, owners.is_visible, owners.shoulder_px
    wrist, rows = hands.wrist_px, np.arange(len(hands))
    to_wrists = np.linalg.norm(points[:, WRISTS] - wrist[:, None], axis=-1) / width[:, None]
    to_wrists = np.where(visible[:, WRISTS], to_wrists, np.inf)
    side = to_wrists.argmin(axis=1)
    own_elbow = np.array(ELBOWS)[side]
    shoulders = points[:, SHOULDERS].mean(axis=1)
    rise = (shoulders[:, 1] - wrist[:, 1]) / width
    top = np.where(visible[:, HEAD], points[:, HEAD, 1], np.inf).min(axis=1)
    above = np.where(np.isfinite(top), (top - wrist[:, 1]) / width, 0.0)
    forearm = wrist - points[rows, own_elbow]
    upright = -forearm[:, 1] / np.maximum(np.linalg.norm(forearm, axis=-1), 1.0)
    aside = np.abs(wrist[:, 0] - shoulders[:, 0]) / width
    trunk = owners.visibility[:, [Joint.NOSE, *SHOULDERS]].mean(axis=1) * owners.score
    arms = owners.visibility[:, [*ELBOWS, *WRISTS]].mean(axis=1) * owners.score
    head = _head_distance_px(hands, owners, is_found) / width
    return {
        "low": np.clip(-rise, 0.0, 1.0),
        "high": np.clip(rise, 0.0, 1.0),
        "overhead": np.clip(above, 0.0, 1.0),
        "forearm": np.where(visible[rows, own_elbow], upright, 0.0),
        "head": np.clip(1.0 - head / _HEAD_REACH, 0.0, 1.0),
        "inside": np.clip(1.0 - 2.0 * aside, 0.0, 1.0),
        "together": np.clip(1.0 - to_wrists[rows, 1 - side] / _OTHER_REACH, 0.0, 1.0),
        "doubt": np.clip((1.0 - trunk) / _NO_PERSON, 0.0, 1.0),
        "faint": np.where(is_found, 0.0, np.clip((1.0 - arms) / _NO_PERSON, 0.0, 1.0)),
        "apart": np.where(is_found, np.minimum(to_wrists.min(axis=1), 1.0), 0.0),
    }


def _head_distance_px(hands: Hands, owners: Bodies, is_found: BoolArray) -> FloatArray:
    """Shape (H,): from each hand to its owner's face, ears or crown, whichever is nearest."""
    crown = _crowns_px(owners)
    apart = []
    for row in (WRIST, MIDDLE_ROOT, MIDDLE_TIP):
        # Of a hand that was not found nothing but the wrist is known.
        end = np.where(is_found[:, None], hands.landmarks_px[:, row], hands.wrist_px)
        to_crown = np.linalg.norm(end - crown, axis=-1)
        apart.append(np.fmin(head_distance_px(owners, end), to_crown))
    return np.asarray(np.min(apart, axis=0))


def _crowns_px(bodies: Bodies) -> FloatArray:
    """Shape (P, 2): the tops of the heads, where people scratch; NaN where that is not known."""
    joints = [*_EYES, *SHOULDERS]
    eyes, shoulders = (bodies.points_px[:, rows].mean(axis=1) for rows in (_EYES, SHOULDERS))
    is_seen = bodies.is_visible[:, joints].all(axis=1, keepdims=True)
    return np.where(is_seen, eyes + _CROWN * (eyes - shoulders), np.nan)
