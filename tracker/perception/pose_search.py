"""Where in a part of the picture are people? MediaPipe's pose detector."""

from __future__ import annotations

import numpy as np
import onnxruntime

from tracker.containers import FloatArray, ImageArray
from tracker.perception.models import ModelStore
from tracker.perception.pictures import Window
from tracker.perception.regions import Regions, upright_rotation
from tracker.perception.sessions import open_session
from tracker.perception.single_shot import SingleShot

INPUT_PX = 224
#: As `single_shot.PALM_LAYERS`; the last three maps share stride 32.
POSE_LAYERS = ((8, 2), (16, 2), (32, 6))
#: How much larger than the circle around a person the landmark model's region is; it was trained
#: so (Bazarevsky et al., "BlazePose", 2020).
REGION_SCALE = 1.25


class PoseSearch:
    """The pose detector on a window of the picture.

    Args:
        session: The opened model.
    """

    def __init__(self, session: onnxruntime.InferenceSession) -> None:
        self._detector = SingleShot(session, INPUT_PX, POSE_LAYERS, black=-1.0)

    @staticmethod
    def open(store: ModelStore, *, threads: int, provider: str) -> PoseSearch:
        """The pose detector of a store.

        Raises:
            ModelFileError, ConfigError: As `open_session`.
        """
        return PoseSearch(
            open_session(
                store,
                "pose_detection",
                threads=threads,
                fixed_sizes={"batch": 1},
                provider=provider,
            )
        )

    def find(self, bgr: ImageArray, window: Window, confidence: float) -> Regions:
        """The regions in which the people of a window stand, the surest first.

        Args:
            bgr: Shape (height, width, 3), the full image.
            window: The part to search.
            confidence: Score from which a person counts.
        """
        found = self._detector.find(bgr, confidence, window=window)
        return regions_from_alignment(found.keypoints_px[:, :2])


def regions_from_alignment(alignment_px: FloatArray) -> Regions:
    """The regions of people whose hips and circle are known.

    Args:
        alignment_px: Shape (P, 2, 2): the middle of the hips, and a point above the head on the
            circle around the whole person, in the full image.
    """
    hips, circle = alignment_px[:, 0], alignment_px[:, 1]
    radius = np.linalg.norm(circle - hips, axis=-1)
    return Regions(hips, 2.0 * REGION_SCALE * radius, upright_rotation(hips, circle))
