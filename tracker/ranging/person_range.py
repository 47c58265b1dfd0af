"""Where is the owner of a hand? To the side of its ray, and how far along it.

A raised hand stands beside the body, and a laser at leg height looks past the body at the wall:
the beam at the hand's own bearing is the wrong one to ask. But the thumb of a raised hand points
at its owner's head, and the hand is as large as it is near.
"""

from __future__ import annotations

import numpy as np

from tracker.camera import CameraModel
from tracker.containers import FloatArray, Hands

#: Adults' hands: from the wrist to the middle finger's root. Guess from anthropometric tables.
PALM_LENGTH_M = 0.095
#: How far a raised hand stands beside the body's middle (guess).
BESIDE_M = 0.3
#: Relative spread of a range told from a palm's size: people differ by .07 (anthropometric
#: tables), and palms tilt, and models are off, by about .13 (guess) ...
RANGE_SPREAD = 0.15
#: ... and noise of a landmark, which tells on small palms.
LANDMARK_STD_PX = 1.0
#: A palm shorter than this tells no range; some detectors leave landmarks out.
PALM_MIN_PX = 3.0
#: From the index finger's root to the little finger's, in palm lengths (anthropometric tables).
PALM_BREADTH = 0.68
_WRIST, _THUMB_TIP, _INDEX_ROOT, _MIDDLE_ROOT, _PINKY_ROOT = 0, 4, 5, 9, 17
_PALM = [_WRIST, _INDEX_ROOT, _MIDDLE_ROOT, _PINKY_ROOT]


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
    length, breadth = _palm(hands.landmarks_px[:, _PALM])
    side = -np.clip(toward / np.maximum(1.0, np.maximum(length, breadth)), -1.0, 1.0)
    # A landmark that a detector leaves out tells nothing either.
    return np.asarray(np.where(hands.is_owned, 0.0, np.nan_to_num(side)))


def size_misfit(hands: Hands, camera: CameraModel, along_m: FloatArray) -> FloatArray:
    """How badly the size of hands fits distances, in squared standard deviations.

    Args:
        hands: In the picture.
        camera: Intrinsics of the full image.
        along_m: Shape (H, C): distances that each hand is held against.

    Returns:
        Shape (H, C); 0 where the palm is too short to tell.
    """
    palm_px = np.maximum(*palms_px(hands, camera))[:, None]
    spread = np.hypot(RANGE_SPREAD, LANDMARK_STD_PX / palm_px)
    of_size = (np.log(np.maximum(along_m, 0.05) / range_of_palm_m(palm_px, camera)) / spread) ** 2
    return np.asarray(np.where(palm_px >= PALM_MIN_PX, of_size, 0.0))


def range_of_palm_m(palm_px: FloatArray, camera: CameraModel) -> FloatArray:
    """Range at which an adult's palm would look that long, meters."""
    return np.asarray(camera.fy * PALM_LENGTH_M / np.maximum(palm_px, 1.0))


def palms_px(hands: Hands, camera: CameraModel) -> tuple[FloatArray, FloatArray]:
    """Lengths of the palms, each of shape (H,): as seen, and as told by their breadth.

    In pixels of the picture's middle, on an upright cylinder around the camera: there a hand that
    is held up is as large as it is near over the floor, wherever a lens shows it.
    """
    ahead, left, up = camera.rays(hands.landmarks_px[:, _PALM].reshape(-1, 2)).T
    on_cylinder = np.stack([np.arctan2(left, ahead), up / np.hypot(ahead, left)], axis=-1)
    length, breadth = _palm(camera.fy * on_cylinder.reshape(-1, len(_PALM), 2))
    # A landmark beyond the lens's range tells no length.
    return np.fmax(length, 1.0), np.nan_to_num(breadth)


def _palm(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The two lengths of `palms_px`, from points of shape (H, 4, 2) in the order of `_PALM`."""
    length = np.linalg.norm(points[:, 2] - points[:, 0], axis=-1)
    return length, np.linalg.norm(points[:, 3] - points[:, 1], axis=-1) / PALM_BREADTH


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
