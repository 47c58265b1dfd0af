"""An installed mediapipe 0.10 as the hand detector."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import cv2
import numpy as np

from tracker.config import Config
from tracker.containers import CameraImage, Hands
from tracker.errors import ConfigError
from tracker.perception.detector import NO_HINTS, Hints
from tracker.perception.pictures import continues, shrink_picture
from tracker.perception.verdict.raise_rules import judge_raised, rule_refusals

#: What mediapipe is opened with anew when it changes.
_GRAPH_PARAMETERS = (
    "model_complexity", "max_hands", "detection_confidence", "tracking_confidence",
)  # fmt: skip


class MediapipeHands:
    """`detector: mediapipe`: the legacy solution `hands` in video mode, on the shrunk picture.

    Raises:
        ConfigError: mediapipe is not installed, or is too new to have the legacy solutions.
    """

    work = None

    def __init__(self, config: Config) -> None:
        self._config = config
        self._graph = _open_graph(config)
        self._last: CameraImage | None = None

    def find(self, image: CameraImage, hints: Hints = NO_HINTS) -> Hands:
        """Every hand of the image, in pixels of the full image.

        mediapipe keeps the landmark model's score to itself; what it returns has passed
        `tracking_confidence`, and `Hands.score` is 1.
        """
        if self._last is not None and not continues(self._last, image):
            self.reset()
        self._last = image
        picture = shrink_picture(image.bgr, self._config.downscale_factor)
        answer = self._graph.process(cv2.cvtColor(picture, cv2.COLOR_BGR2RGB))
        size = (image.width, image.height)
        landmarks = np.array(
            [[(p.x, p.y) for p in hand.landmark] for hand in answer.multi_hand_landmarks or ()]
        ).reshape(-1, 21, 2) * np.array(size)
        sides = [hand.classification[0] for hand in answer.multi_handedness or ()]
        # It takes the picture for a mirrored one.
        right = [side.score if side.label == "Left" else 1.0 - side.score for side in sides]
        raised, measure = judge_raised(landmarks, size, self._config)
        refusal = rule_refusals(raised, measure, self._config)
        sure = np.ones(len(landmarks))
        return Hands(landmarks, sure, np.array(right), raised, measure, refusal=refusal)

    def reset(self) -> None:
        """Forget the hands of earlier images."""
        self._graph.reset()
        self._last = None

    def configure(self, config: Config) -> None:
        """Take over changed parameters, from the next image on; reopens mediapipe if it must."""
        old, self._config = self._config, config
        if any(getattr(config, name) != getattr(old, name) for name in _GRAPH_PARAMETERS):
            self._graph.close()
            self._graph = _open_graph(config)


def _open_graph(config: Config) -> Any:
    try:
        hands = import_module("mediapipe").solutions.hands
    except (ImportError, AttributeError) as error:
        raise ConfigError(
            f"`detector: mediapipe` needs mediapipe 0.10 with its legacy solutions ({error}); run "
            '\'pip install "mediapipe==0.10.21" "numpy<2"\', or choose `detector: hands`, which '
            "runs the same models without it."
        ) from error
    return hands.Hands(
        static_image_mode=False,
        max_num_hands=config.max_hands,
        model_complexity=config.model_complexity,
        min_detection_confidence=config.detection_confidence,
        min_tracking_confidence=config.tracking_confidence,
    )
