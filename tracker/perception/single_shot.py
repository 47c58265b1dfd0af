"""Where in the picture, or in a part of it, are palms or people? MediaPipe's detectors."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Annotated

import cv2
import numpy as np
import onnxruntime

from tracker.containers import FloatArray, ImageArray
from tracker.containers.rows import Column, Rows
from tracker.perception.pictures import Window, cut_out, shrink_picture
from tracker.perception.regions import box_overlap

#: (stride in pixels, anchors per cell) of each output map of the palm model, in the order of its
#: rows. The last three maps share stride 16 with two anchors each: six a cell.
PALM_LAYERS = ((8, 2), (16, 6))
#: Of the pose detector; the last three maps share stride 32.
POSE_LAYERS = ((8, 2), (16, 2), (32, 6))
#: What overlaps more than this is the same; MediaPipe's value.
SAME_OVERLAP = 0.3


@dataclass(frozen=True, eq=False)
class Detections(Rows):
    """What was found in one picture, the surest first; row i of each array is the same thing.

    Attributes:
        boxes_px: Shape (D, 4): x_min, y_min, x_max, y_max in the full image.
        keypoints_px: Shape (D, K, 2), in the full image. Of palms: wrist, roots of index, middle,
            ring and little finger, two of the thumb; of people: middle of the hips, a point of
            the circle around the person, the same for the upper body.
        score: Shape (D,): in [0, 1].
    """

    boxes_px: Annotated[FloatArray, Column((4,))]
    keypoints_px: Annotated[FloatArray, Column((-1, 2))]
    score: FloatArray

    @staticmethod
    @cache
    def none(keypoints: int = 7) -> Detections:
        """Nothing at all."""
        return Detections(np.zeros((0, 4)), np.zeros((0, keypoints, 2)), np.zeros(0))


class SingleShot:
    """A single-shot detector on a letterboxed picture.

    Args:
        session: The opened model, for inputs of `input_px`.
        input_px: Side of the square that the model sees, a multiple of every stride.
        layers: (stride in pixels, anchors per cell) of each output map.
        black: What the model takes for black; white is 1.
    """

    def __init__(
        self,
        session: onnxruntime.InferenceSession,
        input_px: int = 192,
        layers: tuple[tuple[int, int], ...] = PALM_LAYERS,
        black: float = 0.0,
    ) -> None:
        self._session = session
        self._input_px = input_px
        self._anchors = make_anchors(input_px, layers)
        self._black = np.float32(black)

    def find(
        self,
        bgr: ImageArray,
        confidence: float,
        *,
        window: Window | None = None,
        shrink: int = 1,
    ) -> Detections:
        """Search a picture, or a window of it.

        Args:
            bgr: Shape (height, width, 3), the full image.
            confidence: Score from which something counts.
            window: The part to search, cut to the picture; None is the whole.
            shrink: By which factor the picture is made smaller before the search.
        """
        height, width = bgr.shape[:2]
        left, top, extent_x, extent_y = window or (0, 0, width, height)
        x0, y0, x1, y1 = (
            max(0, left), max(0, top), min(width, left + extent_x), min(height, top + extent_y)
        )  # fmt: skip
        if x1 <= x0 or y1 <= y0:
            return Detections.none()
        picture = shrink_picture(bgr[y0:y1, x0:x1], shrink)
        # The picture in the middle of a black square, and how its pixels map back.
        size = np.array(picture.shape[1::-1])
        per_input_px = size.max() / self._input_px
        origin = (size - size.max()) / 2
        back = np.column_stack([per_input_px * np.eye(2), origin])
        square = cut_out(picture, back, self._input_px, cv2.BORDER_CONSTANT)
        if self._black:
            square = square * (1 - self._black) + self._black
        boxes, logits = self._session.run(["boxes", "scores"], {"image": square})
        found = decode_rows(boxes[0], logits[0, :, 0], self._anchors, confidence)
        # Back through the letterbox and the shrinking; per axis, since rounding to whole pixels
        # shrinks width and height by slightly different factors.
        stretch = np.array([x1 - x0, y1 - y0]) / size
        scale, start = per_input_px * stretch, origin * stretch + (x0, y0)
        return Detections(
            found.boxes_px * np.tile(scale, 2) + np.tile(start, 2),
            found.keypoints_px * scale + start,
            found.score,
        )


def make_anchors(input_px: int, layers: tuple[tuple[int, int], ...] = PALM_LAYERS) -> FloatArray:
    """Centers of all anchors, layer by layer, row by row, the anchors of a cell in succession.

    Shape (A, 2): x and y in pixels of the input; A is 2016 for 192 px, 1400 for 160 px.

    Source: Liu et al., "SSD: Single Shot MultiBox Detector", ECCV 2016; anchors of fixed size
        as in Bazarevsky et al., "BlazeFace", 2019.
    """
    parts = []
    for stride, per_cell in layers:
        centers = (np.arange(input_px // stride) + 0.5) * stride
        x, y = np.meshgrid(centers, centers)
        parts.append(np.repeat(np.stack([x.ravel(), y.ravel()], axis=-1), per_cell, axis=0))
    return np.concatenate(parts)


def probability(logits: FloatArray) -> FloatArray:
    """Of log-odds, however large."""
    limited = np.clip(logits.astype(np.float64), -100.0, 100.0)
    return np.asarray(1.0 / (1.0 + np.exp(-limited)))


def decode_rows(
    boxes: FloatArray, logits: FloatArray, anchors: FloatArray, confidence: float
) -> Detections:
    """Turn the model's rows into detections in pixels of its input, overlapping ones merged.

    Args:
        boxes: Shape (A, 4 + 2 K): center, width, height, then K key points, all in pixels of the
            input; center and key points relative to the anchor.
        logits: Shape (A,).
        anchors: Shape (A, 2), in pixels of the input.
        confidence: Score from which a row counts.
    """
    count = (boxes.shape[1] - 4) // 2
    sure = np.flatnonzero(logits >= float(np.log(confidence / (1.0 - confidence))))
    sure = sure[np.isfinite(boxes[sure]).all(axis=-1)]
    if len(sure) == 0:
        return Detections.none(count)
    score = probability(logits[sure])
    rows, anchor = boxes[sure].astype(np.float64), anchors[sure]
    center, half = rows[:, :2] + anchor, rows[:, 2:4] / 2
    keypoints = rows[:, 4:].reshape(len(rows), count, 2) + anchor[:, None]
    corners = np.concatenate([center - half, center + half], axis=-1)
    return merge_rows(Detections(corners, keypoints, score))


def merge_rows(found: Detections) -> Detections:
    """Weighted non-maximum suppression: what overlaps the surest row is averaged into it.

    Averages are weighted with the scores; the merged row keeps the surest one's score.

    Args:
        found: In any order and any pixels.
    """
    if len(found) == 0:
        return Detections.none(found.keypoints_px.shape[1])
    left = np.argsort(-found.score, kind="stable")
    boxes_px, keypoints_px, score = [], [], []
    while len(left):
        best_px, others_px = found.boxes_px[left[:1]], found.boxes_px[left]
        with_best = box_overlap(best_px, others_px)[0] > SAME_OVERLAP
        with_best[0] = True  # a box without area does not even overlap itself
        same = left[with_best]
        weight = found.score[same] / found.score[same].sum()
        boxes_px.append(weight @ found.boxes_px[same])
        keypoints_px.append(np.tensordot(weight, found.keypoints_px[same], axes=1))
        score.append(found.score[same[0]])
        left = left[~with_best]
    return Detections(np.stack(boxes_px), np.stack(keypoints_px), np.array(score))
