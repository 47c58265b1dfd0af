"""Which arms are up, and which hands are only at the head? What a body says about its hands."""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, Hands, IntArray
from tracker.perception.bodies import HEAD, HIPS, KNEES, SHOULDERS, WRISTS, Bodies, Joint
from tracker.perception.raise_rules import MIDDLE_ROOT, palm_rule

#: A hand belongs to the body with a wrist so close to its own, in widths of the shoulders: the
#: pose model errs by a sixth of a hand, and the arm may have moved since (guess).
_OWN_WRIST_SHOULDERS = 0.6
#: A body must be so close to vouch for a hand: doubt is enough to refuse one, but not to raise it.
#: Ninety-nine in a hundred hands of drawn callers that needed it were closer to the body's wrist;
#: a forearm taken for a hand is not.
VOUCHING_WRIST_SHOULDERS = 0.35
#: How long an own hand may be, in widths of the shoulders: drawn callers' measure 0.3 to 0.9, more
#: if held to the camera, and less if closed. Neighbors much nearer or farther do not fit (guess).
_OWN_HAND_SHOULDERS = (0.18, 1.2)
#: What is so close to the nose, eyes or ears, in widths of the shoulders, is on the face (guess).
_FACE_SHOULDERS = 0.25
#: A hand whose fingers rise less than this, in palms, is bent: callers' hands near their own head
#: rise by 1.5 to 2, one around a cup by 1.3. It must be farther from the head by a factor (guess).
_BENT_PALMS, _BENT_FARTHER = 1.5, 1.25
#: A hand so close to a hip or a knee rests there (guess).
_RESTING_SHOULDERS = 0.5


def judge_arms(bodies: Bodies, config: Config) -> tuple[BoolArray, FloatArray]:
    """Arms whose wrist is well above the shoulder, and not at the head.

    A hand that holds a telephone, drinks or scratches has its wrist above the shoulder too, but
    close to the face.

    Args:
        bodies: Who is there.
        config: `pose_raised_threshold` and `pose_head_clearance`.

    Returns:
        Verdict and rise of the wrist above the shoulder in widths of the shoulders, each of shape
        (P, 2), left arm first; an arm that is not seen is down and measures NaN.
    """
    seen, points = bodies.is_visible, bodies.points_px
    width = bodies.shoulder_px[:, None]
    rise_px = points[:, SHOULDERS, 1] - points[:, WRISTS, 1]
    rise = np.where(seen[:, SHOULDERS] & seen[:, WRISTS], rise_px / width, np.nan)
    head_px = np.stack([head_distance_px(bodies, points[:, wrist]) for wrist in WRISTS], axis=-1)
    is_clear = ~(head_px < config.pose_head_clearance * width)
    return (rise > config.pose_raised_threshold) & is_clear, rise


def head_distance_px(bodies: Bodies, points_px: FloatArray) -> FloatArray:
    """How far one point for each body is from its nose, eyes or ears, whichever is nearest.

    Returns:
        Shape (P,); infinite where nothing of the head is seen.
    """
    apart = np.linalg.norm(bodies.points_px[:, HEAD] - points_px[:, None], axis=-1)
    return np.asarray(np.where(bodies.is_visible[:, HEAD], apart, np.inf).min(axis=1))


def find_owners(
    hands: Hands, bodies: Bodies, reach_shoulders: float = _OWN_WRIST_SHOULDERS
) -> IntArray:
    """Whose hand is it? The body with the nearest wrist, if that is close enough.

    People who are much nearer or farther than the hand, as its size tells, do not come into
    question.

    Args:
        hands: What the hand models found.
        bodies: Who is there.
        reach_shoulders: How close the wrists must be, in widths of the shoulders.

    Returns:
        Shape (H,): rows of `bodies`; -1 where no body fits.
    """
    if len(bodies) == 0 or len(hands) == 0:
        return np.full(len(hands), -1, dtype=np.int64)
    apart = _own_wrist_apart_shoulders(hands, bodies)
    owner = apart.argmin(axis=1)
    return np.where(apart.min(axis=1) < reach_shoulders, owner, -1)


def arms_without_hand(hands: Hands, bodies: Bodies) -> BoolArray:
    """Shape (P, 2): arms at whose wrist no hand was found, left arm first.

    A hand's own length around its wrist is free of other wrists: in a hand that fills the picture
    pose models see bodies of all kinds.
    """
    reach = np.fmax(hands.length_px[:, None], _OWN_WRIST_SHOULDERS * bodies.shoulder_px)
    return np.asarray(~(_wrists_apart_px(hands, bodies) < reach[..., None]).any(axis=0))


def _wrists_apart_px(hands: Hands, bodies: Bodies) -> FloatArray:
    """From each hand to each wrist of each body, shape (H, P, 2); infinite for those not seen."""
    return _apart_px(hands.wrist_px, bodies, WRISTS)


def _own_wrist_apart_shoulders(hands: Hands, bodies: Bodies) -> FloatArray:
    """From each hand to the nearer wrist of each body that it fits.

    Returns:
        Shape (H, P), in widths of the shoulders; infinite where no wrist is seen, or none fits.
    """
    apart = _wrists_apart_px(hands, bodies).min(axis=-1) / bodies.shoulder_px
    return np.where(_fits(hands, bodies), apart, np.inf)


def _head_apart_shoulders(hands: Hands, bodies: Bodies) -> FloatArray:
    """From each hand's fingers' roots to each body's nose, eyes or ears, whichever is nearest.

    Returns:
        Shape (H, P), in widths of the shoulders; infinite where nothing of the head is seen.
    """
    knuckles_px = hands.landmarks_px[:, MIDDLE_ROOT]
    return np.asarray(_apart_px(knuckles_px, bodies, HEAD).min(axis=-1) / bodies.shoulder_px)


def _apart_px(points_px: FloatArray, bodies: Bodies, joints: list[Joint]) -> FloatArray:
    """From each point to each such joint of each body, (H, P, J); infinite for those not seen."""
    apart = np.linalg.norm(points_px[:, None, None] - bodies.points_px[:, joints], axis=-1)
    return np.where(bodies.is_visible[:, joints], apart, np.inf)


def _fits(hands: Hands, bodies: Bodies) -> BoolArray:
    """Hands that are neither too small nor too large for a body, shape (H, P)."""
    size = hands.length_px[:, None] / bodies.shoulder_px
    shortest, longest = _OWN_HAND_SHOULDERS
    return np.asarray((size > shortest) & (size < longest))


def hands_at_head(
    hands: Hands, bodies: Bodies, owner: IntArray, clearance_shoulders: float | FloatArray
) -> BoolArray:
    """Hands at their owner's head: they hold a telephone, drink, scratch.

    Another one's head may well be behind a raised hand. A wrist above the eyes does not clear it:
    so have those who scratch the crown of their head. The hand's own length is no yardstick: that
    of a closed one is guessed by the model.

    Args:
        hands: What the hand models found.
        bodies: Who is there.
        owner: Shape (H,): rows of `bodies`, or -1.
        clearance_shoulders: How far the fingers' roots must be from nose, eyes and ears, in widths
            of the shoulders; one for all, or of shape (H,).

    Returns:
        Shape (H,).
    """
    answer = np.zeros(len(hands), dtype=bool)
    rows = np.flatnonzero(owner >= 0)
    owners = bodies[owner[rows]]
    clearance = np.broadcast_to(clearance_shoulders, len(hands))[rows]
    apart_px = head_distance_px(owners, hands.landmarks_px[rows, MIDDLE_ROOT])
    answer[rows] = apart_px < clearance * owners.shoulder_px
    return answer


def clearance_of(hands: Hands, clearance_shoulders: float) -> FloatArray:
    """How far each hand must be from its owner's head; a bent one may hold a cup, and needs more.

    Args:
        hands: What the hand models found.
        clearance_shoulders: Of a hand that is stretched upwards.

    Returns:
        Shape (H,), in widths of the shoulders.
    """
    _, rise_palms = palm_rule(hands.landmarks_px, 0.0, np.pi)
    return clearance_shoulders * np.where(rise_palms < _BENT_PALMS, _BENT_FARTHER, 1.0)


def hands_below_shoulders(
    hands: Hands, bodies: Bodies, owner: IntArray, rise_min_shoulders: float
) -> BoolArray:
    """Hands that their owner holds before the body, as people do who talk.

    Where somebody was found twice, or two people overlap, each body that could be the owner's has
    a say: doubt is enough to refuse.

    Args:
        hands: What the hand models found.
        bodies: Who is there.
        owner: Shape (H,): rows of `bodies`, or -1.
        rise_min_shoulders: How far the fingers' roots must be above the middle of the shoulders,
            in their widths.

    Returns:
        Shape (H,); False where a shoulder is not seen.
    """
    is_owner = _own_wrist_apart_shoulders(hands, bodies) < VOUCHING_WRIST_SHOULDERS
    is_owner |= owner[:, None] == np.arange(len(bodies))
    shoulders = bodies.points_px[:, SHOULDERS, 1].mean(axis=1)
    rise = (shoulders - hands.landmarks_px[:, None, MIDDLE_ROOT, 1]) / bodies.shoulder_px
    seen = bodies.is_visible[:, SHOULDERS].all(axis=1)
    return np.asarray((is_owner & seen & (rise < rise_min_shoulders)).any(axis=1))


def owners_by_head(hands: Hands, bodies: Bodies, owner: IntArray) -> IntArray:
    """Whose hand could it be at whose head? Owners, completed by those whose wrist is not seen.

    A pose model loses the arm that holds a telephone, bent as it is. What is at the head of a body
    with a lost wrist, and fits that body, is likely to be its hand.

    Args:
        hands: What the hand models found.
        bodies: Who is there.
        owner: Shape (H,): rows of `bodies`, or -1.

    Returns:
        The same, with the body of the nearest head where no owner was known; -1 where none fits.
    """
    if len(bodies) == 0:
        return owner
    may_be = _fits(hands, bodies) & ~bodies.is_visible[:, WRISTS].all(axis=1)
    nearest = np.where(may_be, _head_apart_shoulders(hands, bodies), np.inf).argmin(axis=1)
    return np.where((owner < 0) & may_be.any(axis=1), nearest, owner)


def hands_on_faces(hands: Hands, bodies: Bodies, owner: IntArray) -> BoolArray:
    """Hands of unknown owners on a face: ears and mouths, mostly.

    One too large for that body is nearer, and hides the face; the face would hide a smaller one.

    Args:
        hands: What the hand models found.
        bodies: Who is there.
        owner: Shape (H,): rows of `bodies`, or -1.

    Returns:
        Shape (H,).
    """
    is_there = _head_apart_shoulders(hands, bodies) < _FACE_SHOULDERS
    is_nearer = hands.length_px[:, None] > _OWN_HAND_SHOULDERS[1] * bodies.shoulder_px
    return np.asarray((owner < 0) & (is_there & ~is_nearer).any(axis=1))


def hands_at_rest(hands: Hands, bodies: Bodies, owner: IntArray) -> BoolArray:
    """Hands of unknown owners that lie at somebody's hip or knee, and fit that body.

    A hand in a lap may be misread as one that points up, so far from its true wrist that the body
    is not known for its owner.

    Args:
        hands: What the hand models found.
        bodies: Who is there.
        owner: Shape (H,): rows of `bodies`, or -1.

    Returns:
        Shape (H,).
    """
    ends_px = hands.wrist_px, hands.landmarks_px[:, MIDDLE_ROOT]
    apart_px = np.minimum(*(_apart_px(end, bodies, [*HIPS, *KNEES]) for end in ends_px)).min(-1)
    close = apart_px < _RESTING_SHOULDERS * bodies.shoulder_px
    return np.asarray((owner < 0) & (close & _fits(hands, bodies)).any(axis=1))
