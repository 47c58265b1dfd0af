"""Which hands are in this image, and which of them are raised?"""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import CameraImage, FloatArray, Hands, ImageArray, PerceptionWork
from tracker.perception.hands.following import HandFollower
from tracker.perception.hands.landmarks import LandmarkReader
from tracker.perception.models import ModelStore
from tracker.perception.models.sessions import open_session
from tracker.perception.regions import Regions, regions_from_landmarks
from tracker.perception.single_shot import SingleShot
from tracker.perception.verdict.raise_rules import judge_raised, rule_refusals

#: What the palm model sees of the whole picture and of a piece of it: squares of these sides. The
#: second costs three quarters of the first, the model's own, and finds as much in tiles of 240 px.
WHOLE_INPUT_PX, PIECE_INPUT_PX = 192, 160
_NOWHERE, _NOBODY = np.zeros((0, 4)), np.zeros(0, dtype=bool)


class HandFinder:
    """MediaPipe's hand pipeline on ONNX Runtime: search, landmarks, following, raise rule.

    Args:
        config: `model_complexity`, `inference_threads`, `execution_provider` and the parameters
            of the perception group.
        store: Where the model files live; None takes the default place.

    Raises:
        ModelFileError: A model file is absent or unusable; the message says how to fetch it.
        ConfigError: ONNX Runtime has no such execution provider.

    Source: Zhang et al., "MediaPipe Hands: On-device Real-time Hand Tracking", 2020.
    """

    def __init__(self, config: Config, store: ModelStore | None = None) -> None:
        self._store = store if store is not None else ModelStore()
        self._config = config
        self._follower = self._open(config)
        self._expected_px = _NOWHERE
        self._suggested = Regions.none()
        self._spared = 0
        self._raised = _NOBODY
        self._budget: int | None = None

    def expect(self, boxes_px: FloatArray) -> None:
        """Look into these boxes, shape (E, 4), first in the next image."""
        self._expected_px = boxes_px

    def suggest(self, landmarks_px: FloatArray) -> None:
        """Look without a search whether hands are there in the next image; shape (G, 21, 2)."""
        self._suggested = regions_from_landmarks(landmarks_px)

    def spare(self, places: int) -> None:
        """Search this many places less in the next image, but at least one."""
        self._spared = places

    def set_budget(self, runs: int | None) -> None:
        """How many model runs an image may take from now on; None is as configured."""
        self._budget = runs

    @property
    def work(self) -> PerceptionWork:
        """What the last image cost."""
        return self._follower.work

    @property
    def seen(self) -> ImageArray | None:
        """The last image as the models saw it; None before the first."""
        return self._follower.seen

    def find(self, image: CameraImage) -> Hands:
        """Every known hand of the image, and those that the places searched in it hold.

        `downscale_factor` applies to the whole-frame search; pieces of the picture and landmarks
        are read from the full image, so that their accuracy does not depend on it.
        """
        expected_px, self._expected_px = self._expected_px, _NOWHERE
        suggested, self._suggested = self._suggested, Regions.none()
        spared, self._spared = self._spared, 0
        found, rows = self._follower.step(
            image, self._config, expected_px, self._budget, suggested, spared
        )
        size = (image.width, image.height)
        was_raised = np.append(self._raised, False)[rows]  # row -1 is new
        raised, measure = judge_raised(found.points_px, size, self._config, was_raised)
        self._raised = raised
        return Hands(
            found.points_px,
            found.score,
            found.right,
            raised,
            measure,
            refusal=rule_refusals(raised, measure, self._config),
        )

    def reset(self) -> None:
        """Forget the hands of earlier images."""
        self._follower.reset()
        self._raised = _NOBODY
        self._suggested = Regions.none()

    def configure(self, config: Config) -> None:
        """Take over changed parameters, from the next image on; reopens the models if it must.

        Raises:
            ModelFileError: Other models are needed and cannot be opened; nothing has changed then.
        """
        old = self._config
        engine = ("model_complexity", "inference_threads", "execution_provider")
        if any(getattr(config, name) != getattr(old, name) for name in engine):
            self._follower = self._open(config)
        self._config = config

    def _open(self, config: Config) -> HandFollower:
        complexity, provider = config.model_complexity, config.execution_provider
        name = "palm_detection_full" if complexity else "palm_detection_lite"

        def palm_search(input_px: int) -> SingleShot:
            sizes = {"batch": 1, "height": input_px, "width": input_px}
            session = open_session(
                self._store, name, threads=1, fixed_sizes=sizes, provider=provider
            )
            return SingleShot(session, input_px)

        return HandFollower(
            palm_search(WHOLE_INPUT_PX),
            palm_search(PIECE_INPUT_PX),
            LandmarkReader.open(
                self._store, complexity, threads=config.inference_threads, provider=provider
            ),
        )
