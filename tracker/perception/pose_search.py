"""Where in a part of the picture are people? MediaPipe's pose detector."""

from __future__ import annotations

import cv2
import numpy as np
import onnxruntime

from tracker.containers import FloatArray, ImageArray
from tracker.perception.anchors import make_anchors
from tracker.perception.models import ModelStore
from tracker.perception.palm_search import Window
from tracker.perception.pictures import cut_out
from tracker.perception.regions import Regions, box_overlap, upright_rotation
from tracker.perception.sessions import open_session

INPUT_PX = 224
#: As `anchors.PALM_LAYERS`; the last three maps share stride 32.
POSE_LAYERS = ((8, 2), (16, 2), (32, 6))
#: How much larger than the circle around a person the landmark model's region is; it was trained
#: so (Bazarevsky et al., "BlazePose", 2020).
REGION_SCALE = 1.25
#: Boxes that overlap more than this are the same person; MediaPipe's value.
SAME_PERSON_OVERLAP = 0.3


class PoseSearch:
    """The pose detector on a window of the picture.

    Args:
        session: The opened model.
    """

    def __init__(self, session: onnxruntime.InferenceSession) -> None:
        self._session = session
        self._anchors = make_anchors(INPUT_PX, POSE_LAYERS)

    @staticmethod
    def open(store: ModelStore, *, threads: int, provider: str) -> PoseSearch:
        """The pose detector of a store.

        Raises:
            ModelFileError, ConfigError: As `open_session`.
        """
        sizes = {"batch": 1}
        return PoseSearch(
            open_session(
                store, "pose_detection", threads=threads, fixed_sizes=sizes, provider=provider
            )
        )

    def find(self, bgr: ImageArray, window: Window, confidence: float) -> Regions:
        """The regions in which the people of a window stand, the surest first.

        Args:
            bgr: Shape (height, width, 3), the full image.
            window: Left, top, width, height of the part to search, inside the picture.
            confidence: Score from which a person counts.
        """
        left, top, width, height = window
        side = max(width, height)
        # The window in the middle of a black square.
        per_input_px = side / INPUT_PX
        origin = np.array([width - side, height - side]) / 2
        back = np.array([[per_input_px, 0.0, origin[0]], [0.0, per_input_px, origin[1]]])
        part = bgr[top : top + height, left : left + width]
        square = cut_out(part, back, INPUT_PX, cv2.BORDER_CONSTANT) * np.float32(2) - np.float32(1)
        boxes, logits = self._session.run(["boxes", "scores"], {"image": square})
        keypoints = decode_people(boxes[0], logits[0, :, 0], self._anchors, confidence)
        return regions_from_alignment(keypoints * per_input_px + origin + (left, top))


def decode_people(
    boxes: FloatArray, logits: FloatArray, anchors: FloatArray, confidence: float
) -> FloatArray:
    """Turn the model's rows into people, rows that overlap the surest averaged into it.

    Args:
        boxes: Shape (A, 12): center, width, height, then 4 key points, all in pixels of the input;
            center and key points relative to the anchor.
        logits: Shape (A,).
        anchors: Shape (A, 2), in pixels of the input.
        confidence: Score from which a row counts.

    Returns:
        The middle of the hips and a point of the circle around each person, shape (P, 2, 2), in
        pixels of the input; the surest person first.
    """
    score = 1.0 / (1.0 + np.exp(-np.clip(logits.astype(np.float64), -100.0, 100.0)))
    sure = np.flatnonzero((score >= confidence) & np.all(np.isfinite(boxes), axis=-1))
    sure = sure[np.argsort(-score[sure], kind="stable")]
    rows, anchor = boxes[sure].astype(np.float64), anchors[sure]
    center, half = rows[:, :2] + anchor, rows[:, 2:4] / 2
    corners = np.concatenate([center - half, center + half], axis=-1)
    keypoints = rows[:, 4:8].reshape(-1, 2, 2) + anchor[:, None]
    same = box_overlap(corners, corners) > SAME_PERSON_OVERLAP
    same |= np.eye(len(same), dtype=bool)  # a box without area is a person, too
    people, is_left = [], np.ones(len(rows), dtype=bool)
    while is_left.any():
        group = is_left & same[is_left.argmax()]
        people.append(np.average(keypoints[group], axis=0, weights=score[sure[group]]))
        is_left &= ~group
    return np.array(people).reshape(-1, 2, 2)


def regions_from_alignment(alignment_px: FloatArray) -> Regions:
    """The regions of people whose hips and circle are known.

    Args:
        alignment_px: Shape (P, 2, 2): the middle of the hips, and a point above the head on the
            circle around the whole person, in the full image.
    """
    hips, circle = alignment_px[:, 0], alignment_px[:, 1]
    radius = np.linalg.norm(circle - hips, axis=-1)
    return Regions(hips, 2.0 * REGION_SCALE * radius, upright_rotation(hips, circle))
