"""What is the shape of a hand, wherever it is, however large, and however it is turned?"""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray

WRIST, THUMB_ROOT, THUMB_TIP, INDEX_ROOT, LITTLE_ROOT = 0, 2, 4, 5, 17
_ROOTS, _TIPS, _MIDDLE_JOINTS = [5, 9, 13, 17], [8, 12, 16, 20], [6, 10, 14, 18]
#: How many numbers `hand_shape` gives for a hand.
SIZE = 40
#: No point of a hand is farther from the wrist than this, in palm lengths.
_FARTHEST = 4.0


def hand_shape(landmarks_px: FloatArray) -> FloatArray:
    """Landmarks without the wrist, shape (H, 40): x and y in lengths of the palm.

    The wrist is the origin and the fingers begin straight above it. The index finger's root lies
    to the right, as in a right hand's palm and a left hand's back; the others are mirrored, which
    needs no word of the model about the side. The length is that of the palm or its width,
    whichever is seen less foreshortened.

    Args:
        landmarks_px: Shape (H, 21, 2): x to the right, y down, in MediaPipe's order.
    """
    points = landmarks_px - landmarks_px[:, [WRIST]]
    along, size = _palm(points)
    along = along / np.maximum(np.linalg.norm(along, axis=-1, keepdims=True), 1e-9)
    across = np.stack([-along[:, 1], along[:, 0]], axis=-1)
    is_left = ((points[:, INDEX_ROOT] - points[:, LITTLE_ROOT]) * across).sum(axis=-1) < 0.0
    across = np.where(is_left[:, None], -across, across)
    upright = points[:, 1:] @ np.stack([across, along], axis=-1)
    shape = np.clip(upright / size[:, None, None], -_FARTHEST, _FARTHEST)
    return np.asarray(shape.reshape(-1, SIZE))


def thumb_rise(landmarks_px: FloatArray) -> FloatArray:
    """Shape (H,): 1 for thumbs that point straight up in the picture, -1 straight down."""
    thumb = landmarks_px[:, THUMB_TIP] - landmarks_px[:, THUMB_ROOT]
    length = np.linalg.norm(thumb, axis=-1)
    return np.asarray(-thumb[:, 1] / np.maximum(length, 1e-9))


def palm_faces(landmarks_px: FloatArray, right: FloatArray) -> FloatArray:
    """Shape (H,): how much of the palm the camera sees; below 0 it is the back.

    Twice the area of the triangle of wrist and outer finger roots, in palm lengths; a hand that
    faces the camera measures about .7.
    """
    points = landmarks_px - landmarks_px[:, [WRIST]]
    along, size = _palm(points)
    width = points[:, INDEX_ROOT] - points[:, LITTLE_ROOT]
    area = along[:, 0] * width[:, 1] - along[:, 1] * width[:, 0]
    return np.asarray(np.where(right < 0.5, -area, area) / size**2)


def finger_stretch(landmarks_px: FloatArray) -> FloatArray:
    """Shape (H, 4): 1 for fingers that are stretched, -1 for bent ones; index to little finger.

    How much farther from the wrist the tip is than the middle joint, in half palm lengths.
    """
    points = landmarks_px - landmarks_px[:, [WRIST]]
    _, size = _palm(points)
    tips, joints = (np.linalg.norm(points[:, rows], axis=-1) for rows in (_TIPS, _MIDDLE_JOINTS))
    return np.asarray(np.clip((tips - joints) / (0.5 * size[:, None]), -1.0, 1.0))


def _palm(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """From the wrist to the middle of the fingers' roots, shape (H, 2), and the size, (H,)."""
    along = points[:, _ROOTS].mean(axis=1)
    width = np.linalg.norm(points[:, INDEX_ROOT] - points[:, LITTLE_ROOT], axis=-1)
    # The palm is 1.4 times as long as it is wide.
    size = np.maximum(np.linalg.norm(along, axis=-1), 1.4 * width)
    return along, np.maximum(size, 1e-6)
