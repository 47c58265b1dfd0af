"""Which piece of the picture holds one hand? Rotated squares, from palms and from landmarks."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from tracker.containers import BoolArray, FloatArray
from tracker.containers.rows import Column, Rows

#: How much of the hand's own size a region takes in, and how far its center moves towards the
#: fingers, in sizes. The landmark model was trained on regions of exactly these shapes (Zhang et
#: al., "MediaPipe Hands", 2020), so they are no parameters.
PALM_SCALE, PALM_SHIFT = 2.6, 0.5
LANDMARK_SCALE, LANDMARK_SHIFT = 2.0, 0.1
#: How much larger than the circle around a person the region of the pose landmarks is; the model
#: was trained so (Bazarevsky et al., "BlazePose", 2020).
REGION_SCALE = 1.25

WRIST, INDEX_ROOT, MIDDLE_ROOT, RING_ROOT = 0, 5, 9, 13
#: The landmarks that span a hand's region: without fingertips, so that it stays the same size when
#: the fingers close.
STEADY_LANDMARKS = (0, 1, 2, 3, 5, 6, 9, 10, 13, 14, 17, 18)
#: Key points of the palm model that give its direction.
PALM_WRIST, PALM_MIDDLE_ROOT = 0, 2


@dataclass(frozen=True, eq=False)
class Regions(Rows):
    """Rotated squares in the full image; row i of each array is one region.

    Attributes:
        center_px: Shape (R, 2): x to the right, y down.
        side_px: Shape (R,).
        rotation_rad: Shape (R,): 0 where the fingers point up, positive clockwise on the screen.
    """

    center_px: Annotated[FloatArray, Column((2,))]
    side_px: FloatArray
    rotation_rad: FloatArray


def regions_from_palms(boxes_px: FloatArray, keypoints_px: FloatArray) -> Regions:
    """Where the hands of palms lie: boxes of shape (P, 4), the model's key points (P, 7, 2)."""
    rotation = upright_rotation(keypoints_px[:, PALM_WRIST], keypoints_px[:, PALM_MIDDLE_ROOT])
    size = boxes_px[:, 2:] - boxes_px[:, :2]
    center = (boxes_px[:, :2] + boxes_px[:, 2:]) / 2
    forward = np.stack([np.zeros(len(size)), -PALM_SHIFT * size[:, 1]], axis=-1)
    center = center + _rotate(forward, np.cos(rotation), np.sin(rotation))
    return Regions(center, PALM_SCALE * size.max(axis=-1), rotation)


def regions_from_landmarks(landmarks_px: FloatArray) -> Regions:
    """Where hands will be looked for in the next image; from landmarks of shape (H, 21, 2)."""
    roots = landmarks_px[:, [INDEX_ROOT, RING_ROOT]].mean(axis=1)
    towards = (roots + landmarks_px[:, MIDDLE_ROOT]) / 2
    rotation = upright_rotation(landmarks_px[:, WRIST], towards)
    points = landmarks_px[:, STEADY_LANDMARKS]
    origin = (points.min(axis=1) + points.max(axis=1)) / 2
    cos, sin = np.cos(rotation), np.sin(rotation)
    upright = _rotate(points - origin[:, None], cos[:, None], -sin[:, None])
    low, high = upright.min(axis=1), upright.max(axis=1)
    size = high - low
    # How far the center lies along the hand's own axes; "up" is toward the fingers.
    inside = (low + high) / 2
    inside[:, 1] -= LANDMARK_SHIFT * size[:, 1]
    return Regions(
        origin + _rotate(inside, cos, sin), LANDMARK_SCALE * size.max(axis=-1), rotation
    )


def regions_from_alignment(alignment_px: FloatArray) -> Regions:
    """The regions of people whose hips and circle are known.

    Args:
        alignment_px: Shape (P, 2, 2): the middle of the hips, and a point above the head on the
            circle around the whole person, in the full image.
    """
    hips, circle = alignment_px[:, 0], alignment_px[:, 1]
    radius = np.linalg.norm(circle - hips, axis=-1)
    return Regions(hips, 2.0 * REGION_SCALE * radius, upright_rotation(hips, circle))


def upright_rotation(wrist_px: FloatArray, fingers_px: FloatArray) -> FloatArray:
    """How far hands are turned clockwise from pointing up, shape (H,), radians in [-pi, pi].

    Args:
        wrist_px: Shape (H, 2).
        fingers_px: Shape (H, 2): where the fingers begin.
    """
    along = fingers_px - wrist_px
    return np.asarray(np.arctan2(along[:, 0], -along[:, 1]), dtype=np.float64)


def image_from_input(regions: Regions, input_px: int) -> FloatArray:
    """Affine maps from pixels of a model's square input to the image's, shape (R, 2, 3)."""
    scale = regions.side_px / input_px
    cos, sin = scale * np.cos(regions.rotation_rad), scale * np.sin(regions.rotation_rad)
    linear = np.stack([np.stack([cos, -sin], -1), np.stack([sin, cos], -1)], axis=1)
    corner = regions.center_px - linear.sum(axis=-1) * (input_px / 2)
    return np.concatenate([linear, corner[:, :, None]], axis=-1)


def overlap(first: Regions, second: Regions) -> FloatArray:
    """Intersection over union of every pair, (F, S), as if the squares were not turned."""
    return box_overlap(_upright_boxes(first), _upright_boxes(second))


def box_overlap(first: FloatArray, second: FloatArray) -> FloatArray:
    """Intersection over union of every pair of boxes.

    Args:
        first: Shape (F, 4): x_min, y_min, x_max, y_max.
        second: Shape (S, 4), likewise.

    Returns:
        Shape (F, S), in [0, 1]; boxes without area overlap with nothing.
    """
    low = np.maximum(first[:, None, :2], second[None, :, :2])
    high = np.minimum(first[:, None, 2:], second[None, :, 2:])
    common = np.prod(np.maximum(high - low, 0.0), axis=-1)
    union = _areas(first)[:, None] + _areas(second)[None, :] - common
    ratio: FloatArray = np.divide(common, union, out=np.zeros_like(common), where=union > 0.0)
    return ratio


def first_of_each(same: BoolArray, order: Iterable[int]) -> BoolArray:
    """Mask of the rows that are not the same as a row kept before them.

    Args:
        same: Shape (N, N), symmetric: pairs of rows that mean the same thing.
        order: Every row once, the best first.
    """
    keep = np.zeros(len(same), dtype=bool)
    for row in order:
        keep[row] = not np.any(same[row] & keep)
    return keep


def _areas(boxes: FloatArray) -> FloatArray:
    return np.asarray(np.prod(np.maximum(boxes[:, 2:] - boxes[:, :2], 0.0), axis=-1))


def _upright_boxes(regions: Regions) -> FloatArray:
    half = regions.side_px[:, None] / 2
    return np.concatenate([regions.center_px - half, regions.center_px + half], axis=-1)


def _rotate(vectors: FloatArray, cos: FloatArray, sin: FloatArray) -> FloatArray:
    """Turn vectors of shape (..., 2) clockwise on the screen, by angles of shape (...)."""
    x, y = vectors[..., 0], vectors[..., 1]
    return np.stack([cos * x - sin * y, sin * x + cos * y], axis=-1)
