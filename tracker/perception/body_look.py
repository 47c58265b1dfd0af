"""Who is in this part of the picture, and how does somebody known hold their arms now?"""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

import numpy as np

from tracker.config import Config
from tracker.containers import ImageArray
from tracker.perception.bodies import Bodies
from tracker.perception.models import ModelStore
from tracker.perception.palm_search import Window
from tracker.perception.pose_file import PoseFile
from tracker.perception.pose_landmarks import PoseReader
from tracker.perception.pose_search import PoseSearch, regions_from_alignment

#: People of a window whose joints are read, the surest first.
_READS = 2
#: The window around somebody known is so many times as large as what was seen of them.
_MARGIN = 1.4


class BodyLook(Protocol):
    """One look of a pose model."""

    def around(self, bgr: ImageArray, window: Window) -> Bodies:
        """Everybody whom it sees in a window of the picture."""
        ...

    def again(self, bgr: ImageArray, body: Bodies) -> Bodies:
        """One known body, as it is in this picture; nobody where it is gone."""
        ...


class MediapipeLook:
    """MediaPipe's pose models; somebody known is read without a search.

    Args:
        store: Where the model files live.
        config: The pose group.

    Raises:
        ModelFileError: A model file is absent or unusable; the message says how to fetch it.
        ConfigError: ONNX Runtime has no such execution provider.
    """

    def __init__(self, store: ModelStore, config: Config) -> None:
        threads, provider = config.inference_threads, config.execution_provider
        self._searcher = PoseSearch.open(store, threads=threads, provider=provider)
        self._reader = PoseReader.open(store, threads=threads, provider=provider)
        self._score_min = config.pose_confidence

    def around(self, bgr: ImageArray, window: Window) -> Bodies:
        """Everybody whom the models see in a window, the surest two."""
        regions = self._searcher.find(bgr, window, self._score_min)[:_READS]
        bodies, alignment_px = self._reader.read(bgr, regions)
        bodies = bodies.aligned(alignment_px)
        return bodies[bodies.score >= self._score_min]

    def again(self, bgr: ImageArray, body: Bodies) -> Bodies:
        """One known body, read anew."""
        bodies, alignment_px = self._reader.read(bgr, regions_from_alignment(body.alignment_px))
        bodies = bodies.aligned(alignment_px)
        return bodies[bodies.score >= self._score_min]


class FileLook:
    """The pose model in the user's own file, which looks at windows alone.

    Args:
        config: `pose_model` and the pose group.

    Raises:
        ModelFileError: The file is absent, no ONNX file, or of no layout that is understood.
        ConfigError: ONNX Runtime has no such execution provider.
    """

    def __init__(self, config: Config) -> None:
        self._model = PoseFile.open(Path(config.pose_model), config)
        self._score_min = config.pose_confidence

    def around(self, bgr: ImageArray, window: Window) -> Bodies:
        """Everybody whom the model sees in a window."""
        bodies = self._model.look(bgr, window)
        return bodies[bodies.score >= self._score_min]

    def again(self, bgr: ImageArray, body: Bodies) -> Bodies:
        """Whoever is nearest to where somebody known was."""
        points = body.points_px[0][body.is_visible[0]]
        low, high = points.min(axis=0), points.max(axis=0)
        middle, half = (low + high) / 2, _MARGIN * (high - low).max() / 2
        size = (bgr.shape[1], bgr.shape[0])
        left, top = np.clip(middle - half, 0, size).astype(int).tolist()
        right, bottom = np.clip(middle + half, 0, size).astype(int).tolist()
        if right <= left or bottom <= top:
            return Bodies.none()
        found = self.around(bgr, (left, top, right - left, bottom - top))
        apart = np.linalg.norm(found.points_px - body.points_px, axis=-1).mean(axis=-1)
        return found[np.argsort(apart, kind="stable")[:1]]
