"""Which body does a raised hand belong to? The person-sized cluster that fits it, beside its ray.

A raised hand stands beside the body, and a laser at leg height looks past the body at the wall:
the beam at the hand's own bearing is the wrong one to ask. Of several people beside the ray the
picture tells which: the thumb of a raised hand points at its owner's head, and the hand is as
large as it is near.
"""

from __future__ import annotations

import numpy as np

from tracker.camera import CameraModel
from tracker.containers import BoolArray, FloatArray, Hands, IntArray
from tracker.ranging.people import PersonClusters
from tracker.ranging.rays import HandRays

#: Adults' hands: from the wrist to the middle finger's root. Guess from anthropometric tables.
_PALM_LENGTH_M = 0.095
#: How far a raised hand stands beside the body's middle, and how much that varies (guesses).
BESIDE_M, _BESIDE_STD_M = 0.3, 0.2
#: The same of the middle of shoulders and hips, which a lean moves (guess).
_TORSO_STD_M = 0.08
#: Relative spread of a range told from a palm's size, since people differ (guess) ...
_RANGE_SPREAD = 0.2
#: ... and noise of a landmark, which tells on small palms.
_LANDMARK_STD_PX = 1.0
#: A palm shorter than this tells no range; some detectors leave landmarks out.
_PALM_MIN_PX = 3.0
#: From the index finger's root to the little finger's, in palm lengths (anthropometric tables).
_PALM_BREADTH = 0.68
#: 99 of 100 owners fit better (chi-square of two numbers); beyond, the scan does not show them.
_MISFIT_MAX = 9.2
#: Furniture is so much unlikelier than people to raise a hand: two standard deviations (guess).
#: Something slim alone is furniture more often than a leg, and must fit the hand well.
_FURNITURE_MISFIT = 4.0
_WRIST, _THUMB_TIP, _INDEX_ROOT, _MIDDLE_ROOT, _PINKY_ROOT = 0, 4, 5, 9, 17


def owners(
    rays: HandRays,
    hands: Hands,
    camera: CameraModel,
    people: PersonClusters,
    is_background: BoolArray,
    arm_reach_m: float,
) -> IntArray:
    """For each hand the cluster within an arm's reach of its ray that fits it best.

    Args:
        rays: Hands' directions.
        hands: The same hands in the picture.
        camera: Intrinsics of the full image.
        people: Clusters in the fixed frame of the rays.
        is_background: Shape (C,): which of them have stood still for long. They own a hand only
            where nobody else fits it nearly as well.
        arm_reach_m: So far to each side of the ray is searched.

    Returns:
        Shape (H,): rows of `people`; -1 where nobody stands there whom the hand could belong to.
    """
    if len(people) == 0 or len(hands) == 0:
        return np.full(len(hands), -1, dtype=np.int64)
    heading = rays.bearing_rad + rays.origin[2]
    along, across = ray_coordinates(people.xy_m, rays.origin[:2], heading)
    beside = (along > 0.0) & (np.abs(across) <= arm_reach_m)
    offset = BESIDE_M * owner_side(hands, rays.roll_rad)
    beside_m = np.where(hands.is_owned, _TORSO_STD_M, _BESIDE_STD_M)[:, None]
    misfit = ((across - offset[:, None]) / beside_m) ** 2 + size_misfit(hands, camera, along)
    misfit += _FURNITURE_MISFIT * people.is_slim
    beside &= misfit <= _MISFIT_MAX
    misfit += _FURNITURE_MISFIT * is_background
    best = np.argmin(np.where(beside, misfit, np.inf), axis=1)
    return np.where(beside.any(axis=1), best, -1)


def owner_side(hands: Hands, roll_rad: float = 0.0) -> FloatArray:
    """On which side of the hand its owner should stand, shape (H,), from 1 (left) to -1 (right).

    Whether it is a left or a right hand, seen from the front or from behind: held up beside the
    head, its thumb is on the head's side. A hand seen edge-on tells nothing. Where the ray is the
    torso's, the owner stands on it.

    Args:
        hands: In the picture.
        roll_rad: Of the camera; `HandRays.roll_rad`.
    """
    across = hands.landmarks_px[:, _THUMB_TIP] - hands.landmarks_px[:, _PINKY_ROOT]
    toward = across @ np.array([np.cos(roll_rad), -np.sin(roll_rad)])
    side = -np.clip(toward / _palm_px(hands), -1.0, 1.0)
    return np.asarray(np.where(hands.is_owned, 0.0, side))


def size_misfit(hands: Hands, camera: CameraModel, along_m: FloatArray) -> FloatArray:
    """How badly the size of hands fits distances, in squared standard deviations.

    Args:
        hands: In the picture.
        camera: Intrinsics of the full image.
        along_m: Shape (H, C): distances that each hand is held against.

    Returns:
        Shape (H, C); 0 where the palm is too short to tell.
    """
    palm_px = _palm_px(hands)[:, None]
    range_m = _range_from_size(hands, camera)[:, None]
    spread = np.hypot(_RANGE_SPREAD, _LANDMARK_STD_PX / palm_px)
    of_size = (np.log(np.maximum(along_m, 0.05) / range_m) / spread) ** 2
    return np.asarray(np.where(palm_px >= _PALM_MIN_PX, of_size, 0.0))


def _range_from_size(hands: Hands, camera: CameraModel) -> FloatArray:
    """Range at which an adult's palm would look that long, shape (H,), meters."""
    return np.asarray(camera.fy * _PALM_LENGTH_M / _palm_px(hands))


def _palm_px(hands: Hands) -> FloatArray:
    """Length of the palms, shape (H,); by its breadth where a palm tilts away from the camera."""
    points = hands.landmarks_px
    length = np.linalg.norm(points[:, _MIDDLE_ROOT] - points[:, _WRIST], axis=-1)
    breadth = np.linalg.norm(points[:, _INDEX_ROOT] - points[:, _PINKY_ROOT], axis=-1)
    return np.asarray(np.maximum(np.maximum(length, breadth / _PALM_BREADTH), 1.0))


def ray_coordinates(
    points_m: FloatArray, origin_m: FloatArray, heading_rad: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """How far points lie along rays, and how far to their left.

    Args:
        points_m: Shape (C, 2).
        origin_m: Shape (2,): where all rays begin.
        heading_rad: Shape (H,), in the frame of the points.

    Returns:
        Two arrays of shape (H, C), in meters.
    """
    offset = points_m - origin_m
    direction = np.stack([np.cos(heading_rad), np.sin(heading_rad)], axis=-1)
    left = np.stack([-direction[:, 1], direction[:, 0]], axis=-1)
    return direction @ offset.T, left @ offset.T
