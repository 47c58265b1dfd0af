"""Who is in the picture, and how do they hold their arms? What `detector: pose` finds.

The pose detector sees the most prominent people of a picture alone, so it searches upright strips,
one in an image; whoever was found is followed by the landmarks.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from tracker.config import Config
from tracker.containers import CameraImage, FloatArray, ImageArray
from tracker.perception.bodies import Bodies, one_row_each
from tracker.perception.known_bodies import KnownBodies
from tracker.perception.models import ModelStore
from tracker.perception.palm_search import Window
from tracker.perception.pose_landmarks import PoseReader
from tracker.perception.pose_search import PoseSearch, regions_from_alignment
from tracker.perception.regions import Regions
from tracker.perception.strips import upright_strips

#: Two regions whose centers are closer than this, in sides, hold the same person: a third of a
#: meter, as a side measures about 2.4 m of a person who stands (guess).
_SAME_PERSON_SIDES = 0.15


class Searcher(Protocol):
    """What a `BodyFinder` needs of a `PoseSearch`."""

    def find(self, bgr: ImageArray, window: Window, confidence: float) -> Regions:
        """Regions of people, the surest first."""
        ...


class Reader(Protocol):
    """What a `BodyFinder` needs of a `PoseReader`."""

    def read(self, bgr: ImageArray, regions: Regions) -> tuple[Bodies, FloatArray]:
        """Bodies, and where to look for them next."""
        ...


class BodyFinder(KnownBodies):
    """MediaPipe's pose models over strips, people followed between the searches.

    Args:
        searcher: Finds people.
        reader: Reads their joints.
        config: The pose group.

    Source: Bazarevsky et al., "BlazePose: On-device Real-time Body Pose Tracking", 2020.
    """

    def __init__(self, searcher: Searcher, reader: Reader, config: Config) -> None:
        super().__init__(config)
        self._searcher = searcher
        self._reader = reader

    @staticmethod
    def open(config: Config, store: ModelStore) -> BodyFinder:
        """The pose models of a store.

        Raises:
            ModelFileError: A model file is absent or unusable; the message says how to fetch it.
            ConfigError: ONNX Runtime has no such execution provider.
        """
        threads, provider = config.inference_threads, config.execution_provider
        return BodyFinder(
            PoseSearch.open(store, threads=threads, provider=provider),
            PoseReader.open(store, threads=threads, provider=provider),
            config,
        )

    def reset(self) -> None:
        """Forget everybody."""
        super().reset()
        self._searches = 0

    def _search(self, image: CameraImage) -> Regions:
        """The people of the next strip who are not known."""
        strips = upright_strips(image.width, image.height)
        window = strips[self._searches % len(strips)]
        self._searches += 1
        found = self._searcher.find(image.bgr, window, self._config.pose_confidence)
        known = regions_from_alignment(self._known.alignment_px)
        apart = np.linalg.norm(found.center_px[:, None] - known.center_px[None], axis=-1)
        is_new = ~(apart < _SAME_PERSON_SIDES * found.side_px[:, None]).any(axis=1)
        return found[is_new][: max(self._config.max_hands - len(known), 0)]

    def _look(self, image: CameraImage, known: Bodies) -> Bodies:
        """Read everybody known, and whom the next strip shows."""
        new = self._search(image)
        regions = Regions.concatenate(new, regions_from_alignment(known.alignment_px))
        bodies, alignment_px = self._reader.read(image.bgr, regions[: self._config.max_hands])
        bodies = bodies.aligned(alignment_px)
        stays = np.isfinite(alignment_px).all(axis=(1, 2))
        bodies = bodies[stays & (bodies.score >= self._config.pose_confidence)]
        return bodies[one_row_each(bodies)]
