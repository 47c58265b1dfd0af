"""Where are the 21 points of each hand, and is it a hand at all?"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any, TypeVar

import cv2
import numpy as np
import onnxruntime

from tracker.containers import FloatArray, ImageArray
from tracker.containers.rows import Column, Rows
from tracker.perception.abreast import Abreast
from tracker.perception.models import ModelStore, file_to_run
from tracker.perception.models.sessions import open_session
from tracker.perception.pictures import cut_out
from tracker.perception.regions import Regions, image_from_input

INPUT_PX = 224
T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Landmarks(Rows):
    """Results of the landmark model; row i of each array is region i.

    Attributes:
        points_px: Shape (R, 21, 2): x to the right, y down, in the full image.
        score: Shape (R,): probability that the region holds a hand.
        right: Shape (R,): probability that it is a right hand, in a picture that is not mirrored.
    """

    points_px: Annotated[FloatArray, Column((21, 2))]
    score: FloatArray
    right: FloatArray


class LandmarkReader:
    """The landmark model, on one hand with all threads or beside other calls of one thread each.

    Args:
        alone: Session for a single hand; may use several threads, and does in single precision.
        one_thread: Session of one thread, called from `threads` Python threads at once; two
            half-loaded cores do four hands in 0.58 of the time that way, where two threads
            inside one call save next to nothing.
        threads: Processor threads.
    """

    def __init__(
        self,
        alone: onnxruntime.InferenceSession,
        one_thread: onnxruntime.InferenceSession,
        threads: int,
    ) -> None:
        self._alone = alone
        self._one_thread = one_thread
        self._abreast = Abreast(threads)

    @staticmethod
    def open(
        store: ModelStore,
        complexity: int,
        *,
        threads: int,
        provider: str = "cpu",
        numbers: str = "fp32",
    ) -> LandmarkReader:
        """The lite (0) or full (1) landmark model of a store; raises as `open_session`."""
        name = "hand_landmark_full" if complexity else "hand_landmark_lite"
        how: dict[str, Any] = {
            "fixed_sizes": {"batch": 1}, "provider": provider, "numbers": numbers
        }  # fmt: skip
        one_thread = open_session(store, name, threads=1, **how)
        alone = one_thread
        # In 8 bits a second thread gains nothing: it is late for each of so many short steps, and
        # one that spins in wait for them takes twice the processor's time.
        if threads > 1 and file_to_run(store, name, numbers, provider) == name:
            alone = open_session(store, name, threads=threads, **how)
        return LandmarkReader(alone, one_thread, threads)

    def read_beside(
        self, bgr: ImageArray, regions: Regions, calls: Sequence[Callable[[], T]]
    ) -> tuple[Landmarks, list[T]]:
        """Look at each region of a picture, while other models of one thread each are called.

        Args:
            bgr: Shape (height, width, 3), the full image.
            regions: In its pixels; what lies outside of the picture repeats its edge.
            calls: Run first, since more may follow from them.

        Returns:
            The landmarks, and what the calls returned.
        """
        to_image = image_from_input(regions, INPUT_PX)
        is_alone = len(regions) + len(calls) < 2
        session = self._alone if is_alone else self._one_thread
        looks = [partial(_look, session, bgr, matrix) for matrix in to_image]
        all_returned: list[Any] = self._abreast.run([*calls, *looks])
        returned, answers = all_returned[: len(calls)], all_returned[len(calls) :]
        points = np.array([answer[0] for answer in answers]).reshape(-1, 21, 2)
        projected = points @ to_image[:, :, :2].transpose(0, 2, 1) + to_image[:, None, :, 2]
        hands = Landmarks(
            projected,
            np.array([answer[1] for answer in answers], dtype=np.float64),
            np.array([answer[2] for answer in answers], dtype=np.float64),
        )
        return hands, returned


def _look(
    session: onnxruntime.InferenceSession, bgr: ImageArray, to_image: FloatArray
) -> tuple[FloatArray, float, float]:
    # The edge repeated, as in MediaPipe; with black instead, landmarks of hands at the edge of the
    # image move by 1-4 % of the hand.
    crop = cut_out(bgr, to_image, INPUT_PX, cv2.BORDER_REPLICATE)
    points, presence, right = session.run(["landmarks", "presence", "handedness"], {"image": crop})
    return (
        points.reshape(21, 3)[:, :2].astype(np.float64),
        float(presence[0, 0]),
        float(right[0, 0]),
    )
