"""Where in the picture, or in a part of it, are palms?"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import cv2
import numpy as np
import onnxruntime

from tracker.containers import FloatArray, ImageArray
from tracker.perception.anchors import make_anchors
from tracker.perception.models import ModelStore
from tracker.perception.pictures import ModelInput, cut_out, shrink_picture
from tracker.perception.regions import box_overlap
from tracker.perception.sessions import open_session

#: Part of the full image that is searched: left, top, width, height in pixels.
Window: TypeAlias = tuple[int, int, int, int]

#: Palms that overlap more than this are the same palm; MediaPipe's value.
SAME_PALM_OVERLAP = 0.3
_LOGIT_LIMIT = 100.0  # exp() stays finite


@dataclass(frozen=True, slots=True, eq=False)
class Palms:
    """Palms found in one picture, the surest first; row i of each array is the same palm.

    Attributes:
        boxes_px: Shape (P, 4): x_min, y_min, x_max, y_max in the full image.
        keypoints_px: Shape (P, 7, 2): wrist, roots of index, middle, ring and little finger,
            two of the thumb, in the full image.
        score: Shape (P,): in [0, 1].
    """

    boxes_px: FloatArray
    keypoints_px: FloatArray
    score: FloatArray

    def __len__(self) -> int:
        return len(self.score)

    def __getitem__(self, rows: Any) -> Palms:
        return Palms(self.boxes_px[rows], self.keypoints_px[rows], self.score[rows])

    @staticmethod
    def concatenate(*parts: Palms) -> Palms:
        """Join batches, rows in the order given."""
        return Palms(
            np.concatenate([part.boxes_px for part in parts]),
            np.concatenate([part.keypoints_px for part in parts]),
            np.concatenate([part.score for part in parts]),
        )

    @staticmethod
    def none() -> Palms:
        """No palm at all."""
        return Palms(np.zeros((0, 4)), np.zeros((0, 7, 2)), np.zeros(0))


class PalmSearch:
    """The palm model on a letterboxed picture.

    Args:
        session: The opened model, for inputs of `input_px`.
        input_px: Side of the square that the model sees, a multiple of 32.
    """

    def __init__(self, session: onnxruntime.InferenceSession, input_px: int = 192) -> None:
        self._session = session
        self._input_px = input_px
        self._anchors = make_anchors(input_px)

    @staticmethod
    def open(
        store: ModelStore,
        complexity: int,
        *,
        threads: int,
        input_px: int = 192,
        provider: str = "cpu",
    ) -> PalmSearch:
        """The lite (0) or full (1) palm model of a store.

        Raises:
            ModelFileError, ConfigError: As `open_session`.
        """
        name = "palm_detection_full" if complexity else "palm_detection_lite"
        sizes = {"batch": 1, "height": input_px, "width": input_px}
        session = open_session(store, name, threads=threads, fixed_sizes=sizes, provider=provider)
        return PalmSearch(session, input_px)

    def find(
        self,
        bgr: ImageArray,
        confidence: float,
        *,
        window: Window | None = None,
        shrink: int = 1,
    ) -> Palms:
        """Search a picture, or a window of it.

        Args:
            bgr: Shape (height, width, 3), the full image.
            confidence: Score from which a palm counts.
            window: The part to search, cut to the picture; None is the whole.
            shrink: By which factor the picture is made smaller before the search.
        """
        height, width = bgr.shape[:2]
        x0, y0, x1, y1 = _clip_window(window, width, height)
        if x1 <= x0 or y1 <= y0:
            return Palms.none()
        picture = shrink_picture(bgr[y0:y1, x0:x1], shrink)
        square, per_input_px, origin = _letterbox(picture, self._input_px)
        boxes, logits = self._session.run(["boxes", "scores"], {"image": square})
        palms = decode_palms(boxes[0], logits[0, :, 0], self._anchors, confidence)
        # Back through the letterbox and the shrinking; per axis, since rounding to whole pixels
        # shrinks width and height by slightly different factors.
        stretch = np.array([(x1 - x0) / picture.shape[1], (y1 - y0) / picture.shape[0]])
        scale, start = per_input_px * stretch, origin * stretch + (x0, y0)
        return Palms(
            palms.boxes_px * np.tile(scale, 2) + np.tile(start, 2),
            palms.keypoints_px * scale + start,
            palms.score,
        )


def decode_palms(
    boxes: FloatArray, logits: FloatArray, anchors: FloatArray, confidence: float
) -> Palms:
    """Turn the model's rows into palms, overlapping ones merged.

    Args:
        boxes: Shape (A, 18): center, width, height, then 7 key points, all in pixels of the input;
            center and key points relative to the anchor.
        logits: Shape (A,).
        anchors: Shape (A, 2), in pixels of the input.
        confidence: Score from which a row counts.

    Returns:
        Palms in pixels of the model's input.
    """
    limited = np.clip(logits.astype(np.float64), -_LOGIT_LIMIT, _LOGIT_LIMIT)
    score = 1.0 / (1.0 + np.exp(-limited))
    sure = np.flatnonzero((score >= confidence) & np.all(np.isfinite(boxes), axis=-1))
    rows, anchor = boxes[sure].astype(np.float64), anchors[sure]
    center, half = rows[:, :2] + anchor, rows[:, 2:4] / 2
    palms = Palms(
        np.concatenate([center - half, center + half], axis=-1),
        rows[:, 4:].reshape(-1, 7, 2) + anchor[:, None],
        score[sure],
    )
    return merge_palms(palms)


def merge_palms(palms: Palms, same_overlap: float = SAME_PALM_OVERLAP) -> Palms:
    """Weighted non-maximum suppression: what overlaps the surest palm is averaged into it.

    Averages are weighted with the scores; the merged palm keeps the surest one's score.

    Args:
        palms: In any order and any pixels.
        same_overlap: Intersection over union above which two boxes mean the same palm.
    """
    left = np.argsort(-palms.score, kind="stable")
    merged = []
    while len(left):
        with_best = box_overlap(palms.boxes_px[left[:1]], palms.boxes_px[left])[0] > same_overlap
        with_best[0] = True  # a box without area does not even overlap itself
        same = palms[left[with_best]]
        weight = same.score / same.score.sum()
        merged.append(
            Palms(
                (weight @ same.boxes_px)[None],
                np.tensordot(weight, same.keypoints_px, axes=1)[None],
                same.score[:1],
            )
        )
        left = left[~with_best]
    return Palms.concatenate(Palms.none(), *merged)


def _clip_window(window: Window | None, width: int, height: int) -> tuple[int, int, int, int]:
    if window is None:
        return 0, 0, width, height
    x0, y0, window_width, window_height = window
    return (
        max(0, x0),
        max(0, y0),
        min(width, x0 + window_width),
        min(height, y0 + window_height),
    )


def _letterbox(picture: ImageArray, input_px: int) -> tuple[ModelInput, float, FloatArray]:
    """The picture in the middle of a black square; how its pixels map back."""
    height, width = picture.shape[:2]
    side = max(width, height)
    per_input_px = side / input_px
    origin = np.array([width - side, height - side]) / 2
    back = np.array([[per_input_px, 0.0, origin[0]], [0.0, per_input_px, origin[1]]])
    return cut_out(picture, back, input_px, cv2.BORDER_CONSTANT), per_input_px, origin
