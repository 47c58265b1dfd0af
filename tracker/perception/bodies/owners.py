"""Whose hand is it? The bodies that a pose model saw, against the hands that were found."""

from __future__ import annotations

import numpy as np

from tracker.containers import BoolArray, FloatArray, Hands, IntArray
from tracker.perception.bodies.bodies import HEAD, WRISTS, Bodies, Joint
from tracker.perception.regions import MIDDLE_ROOT

#: A hand belongs to the body with a wrist so close to its own, in widths of the shoulders: the
#: pose model errs by a sixth of a hand, and the arm may have moved since (guess).
_OWN_WRIST_SHOULDERS = 0.6
#: So close a wrist makes an owner sure: ninety-nine in a hundred hands of drawn callers were.
_SURE_WRIST_SHOULDERS = 0.35
#: Of two bodies whose wrists are near, a left wrist has to be so much nearer to a right hand than
#: a right one, in widths of the shoulders: pose models lend a neighbor's hand to a body that they
#: see better (guess).
_OTHER_SIDE_SHOULDERS = 0.4
#: How long an own hand may be, in widths of the shoulders: drawn callers' measure 0.3 to 0.9, more
#: if held to the camera, and less if closed. Neighbors much nearer or farther do not fit (guess).
_OWN_HAND_SHOULDERS = (0.18, 1.2)
#: An open hand in lengths of its palm, wrist to middle finger's root.
_OPEN_PALMS = 1.9


def hand_size_px(hands: Hands) -> FloatArray:
    """Shape (H,): how long each hand is, or would be if it were open; a fist is twice its palm."""
    palm = hands.landmarks_px[:, MIDDLE_ROOT] - hands.wrist_px
    return np.asarray(np.maximum(hands.length_px, _OPEN_PALMS * np.linalg.norm(palm, axis=-1)))


def head_distance_px(bodies: Bodies, points_px: FloatArray) -> FloatArray:
    """From one point for each body to its nose, eyes or ears, whichever is nearest, shape (P,).

    Infinite where nothing of the head is seen.
    """
    apart = np.linalg.norm(bodies.points_px[:, HEAD] - points_px[:, None], axis=-1)
    return np.asarray(np.where(bodies.is_visible[:, HEAD], apart, np.inf).min(axis=1))


def find_owners(
    hands: Hands, bodies: Bodies, reach_shoulders: float = _OWN_WRIST_SHOULDERS
) -> IntArray:
    """Whose hand is it? The body with the nearest wrist, if that is close enough.

    People who are much nearer or farther than the hand, as its size tells, do not come into
    question. A pose model loses the arm that holds a telephone, bent as it is: what nobody's wrist
    is near, but is near the head of a body with a lost wrist, is that body's.

    Args:
        hands: What the hand models found.
        bodies: Who is there.
        reach_shoulders: How close wrist, or head, must be, in widths of the shoulders.

    Returns:
        Shape (H,): rows of `bodies`; -1 where no body fits.
    """
    if len(bodies) == 0 or len(hands) == 0:
        return np.full(len(hands), -1, dtype=np.int64)
    size = hand_size_px(hands)[:, None] / bodies.shoulder_px
    fits = (size > _OWN_HAND_SHOULDERS[0]) & (size < _OWN_HAND_SHOULDERS[1])
    wrist, misfit = _wrist_misfits(hands, bodies)
    misfit = np.where(fits & (wrist < reach_shoulders), misfit, np.inf)
    is_lost = fits & ~bodies.is_visible[:, WRISTS].all(axis=1)
    middle = hands.landmarks_px[:, MIDDLE_ROOT]
    head = np.where(is_lost, apart_px(middle, bodies, HEAD).min(axis=-1), np.inf)
    head = head / bodies.shoulder_px
    owner = np.where(head.min(axis=1) < reach_shoulders, head.argmin(axis=1), -1)
    return np.where(np.isfinite(misfit).any(axis=1), misfit.argmin(axis=1), owner)


def sure_owners(hands: Hands, bodies: Bodies) -> IntArray:
    """The sure owner of each hand: rows of `bodies`, shape (H,); -1 where it is not sure."""
    owner = find_owners(hands, bodies, _SURE_WRIST_SHOULDERS)
    if len(bodies) == 0 or len(hands) == 0:
        return owner
    wrist, misfit = (fit[np.arange(len(hands)), owner] for fit in _wrist_misfits(hands, bodies))
    is_right = hands.right > 0.5  # of two right hands on one body one is a neighbor's
    rivals = (owner[:, None] == owner) & (is_right[:, None] == is_right)
    has_better_rival = (rivals & (misfit < misfit[:, None])).any(axis=1)
    return np.where((wrist < _SURE_WRIST_SHOULDERS) & ~has_better_rival, owner, -1)


def _wrist_misfits(hands: Hands, bodies: Bodies) -> tuple[FloatArray, FloatArray]:
    """How far each hand is from each body's wrist that fits it better, and how badly that fits.

    Two arrays of shape (H, P), in widths of the shoulders; the second counts the wrong side too.
    """
    apart = apart_px(hands.wrist_px, bodies, WRISTS) / bodies.shoulder_px[:, None]
    other_side = np.stack([hands.right, 1.0 - hands.right], axis=-1)
    misfit = apart + _OTHER_SIDE_SHOULDERS * other_side[:, None]
    side = misfit.argmin(axis=-1)[..., None]
    wrist = np.take_along_axis(apart, side, axis=-1)[..., 0]
    return wrist, misfit.min(axis=-1)


def arms_without_hand(hands: Hands, bodies: Bodies) -> BoolArray:
    """Shape (P, 2): arms that are seen and at whose wrist no hand was found, left arm first.

    A hand's own length around its wrist is free of other wrists: in a hand that fills the picture
    pose models see bodies of all kinds.
    """
    seen = bodies.is_visible[:, WRISTS] & np.isfinite(bodies.shoulder_px)[:, None]
    if len(hands) == 0:
        return seen
    reach = np.fmax(hand_size_px(hands)[:, None], _OWN_WRIST_SHOULDERS * bodies.shoulder_px)
    is_near = apart_px(hands.wrist_px, bodies, WRISTS) < reach[..., None]
    return np.asarray(seen & ~is_near.any(axis=0))


def apart_px(points_px: FloatArray, bodies: Bodies, joints: list[Joint]) -> FloatArray:
    """From each point to each such joint of each body, (H, P, J); infinite for those not seen."""
    apart = np.linalg.norm(points_px[:, None, None] - bodies.points_px[:, joints], axis=-1)
    return np.where(bodies.is_visible[:, joints], apart, np.inf)
