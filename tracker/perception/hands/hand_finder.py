"""Which hands are in this image, and which of them are raised?"""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import CameraImage, Hands, PerceptionWork
from tracker.perception.detector import NO_HINTS, Hints
from tracker.perception.hands.following import HandFollower
from tracker.perception.hands.landmarks import LandmarkReader
from tracker.perception.hands.seen_picture import SeenPicture
from tracker.perception.models import ModelStore
from tracker.perception.models.sessions import open_session
from tracker.perception.regions import regions_from_landmarks
from tracker.perception.single_shot import SingleShot
from tracker.perception.verdict.raise_rules import judge_raised, rule_refusals

#: What the palm model sees of the whole picture and of a piece of it: squares of these sides. The
#: second costs three quarters of the first, the model's own, and finds as much in tiles of 240 px.
WHOLE_INPUT_PX, PIECE_INPUT_PX = 192, 160
_NOBODY = np.zeros(0, dtype=bool)


class HandFinder:
    """MediaPipe's hand pipeline on ONNX Runtime: search, landmarks, following, raise rule.

    Args:
        config: `model_complexity`, `inference_threads`, `execution_provider`, `model_numbers` and
            the parameters of the perception group.
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
        self._raised = _NOBODY

    @property
    def work(self) -> PerceptionWork:
        """What the last image cost."""
        return self._follower.work

    @property
    def seen(self) -> SeenPicture | None:
        """The last image as the models saw it; None before the first."""
        return self._follower.seen

    def find(self, image: CameraImage, hints: Hints = NO_HINTS) -> Hands:
        """Every known hand of the image, and those that the places searched in it hold.

        `downscale_factor` applies to the whole-frame search; pieces of the picture and landmarks
        are read from the full image, so that their accuracy does not depend on it.
        """
        suggested = None
        if len(hints.suggested_px):
            suggested = regions_from_landmarks(hints.suggested_px)
        found, rows = self._follower.step(
            image, self._config, hints.expected_px, hints.model_runs, suggested, hints.spared
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

    def configure(self, config: Config) -> None:
        """Take over changed parameters, from the next image on; reopens the models if it must.

        Raises:
            ModelFileError: Other models are needed and cannot be opened; nothing has changed then.
        """
        if runs_otherwise(self._config, config):
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
                self._store,
                complexity,
                threads=config.inference_threads,
                provider=provider,
                numbers=config.model_numbers,
            ),
        )


def runs_otherwise(old: Config, new: Config) -> bool:
    """Whether a change of parameters means that the models must be opened again."""
    engine = ("model_complexity", "inference_threads", "execution_provider", "model_numbers")
    return any(getattr(new, name) != getattr(old, name) for name in engine)
