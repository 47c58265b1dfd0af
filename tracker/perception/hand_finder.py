"""Which hands are in this image, and which of them are raised?"""

from __future__ import annotations

from tracker.config import Config
from tracker.containers import CameraImage, Hands
from tracker.perception.following import HandFollower
from tracker.perception.landmarks import LandmarkReader
from tracker.perception.models import ModelStore
from tracker.perception.palm_search import PalmSearch
from tracker.perception.raise_rules import judge_raised


class HandFinder:
    """MediaPipe's hand pipeline on ONNX Runtime: search, landmarks, following, raise rule.

    Args:
        config: `model_complexity`, `inference_threads` and the parameters of the perception group.
        store: Where the model files live; None takes the default place.

    Raises:
        ModelFileError: A model file is absent or unusable; the message says how to fetch it.

    Source: Zhang et al., "MediaPipe Hands: On-device Real-time Hand Tracking", 2020.
    """

    def __init__(self, config: Config, store: ModelStore | None = None) -> None:
        self._store = store if store is not None else ModelStore()
        self._config = config
        self._follower = self._open(config)

    def find(self, image: CameraImage) -> Hands:
        """Every hand of the image, in pixels of the full image.

        `downscale_factor` applies to the search for new hands; landmarks are read from the full
        image, so that their accuracy does not depend on it.
        """
        found = self._follower.step(image, self._config)
        raised, measure = judge_raised(found.points_px, (image.width, image.height), self._config)
        return Hands(found.points_px, found.score, found.right, raised, measure)

    def reset(self) -> None:
        """Forget the hands of earlier images."""
        self._follower.reset()

    def configure(self, config: Config) -> None:
        """Take over changed parameters, from the next image on; reopens the models if it must.

        Raises:
            ModelFileError: Other models are needed and cannot be opened; nothing has changed then.
        """
        old = self._config
        if (config.model_complexity, config.inference_threads) != (
            old.model_complexity,
            old.inference_threads,
        ):
            self._follower = self._open(config)
        self._config = config

    def _open(self, config: Config) -> HandFollower:
        complexity, threads = config.model_complexity, config.inference_threads
        return HandFollower(
            PalmSearch.open(self._store, complexity, threads=threads),
            LandmarkReader.open(self._store, complexity, threads=threads),
        )
