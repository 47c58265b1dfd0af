"""Who is in the picture, and how do they hold their arms? A little of it anew in each image.

The pose detector sees the most prominent people of a picture alone, so it searches upright strips,
one at a time; whoever was found is followed by the landmarks. Neither is cheap: a budget says how
much is done in an image.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from tracker.config import Config
from tracker.containers import CameraImage, FloatArray, ImageArray, IntArray
from tracker.perception.bodies import Bodies, one_row_each
from tracker.perception.known_bodies import KnownBodies
from tracker.perception.models import ModelStore
from tracker.perception.palm_search import Window
from tracker.perception.pose_landmarks import PoseReader
from tracker.perception.pose_rules import judge_arms
from tracker.perception.pose_search import PoseSearch, regions_from_alignment
from tracker.perception.regions import Regions
from tracker.perception.strips import upright_strips

#: Two regions whose centers are closer than this, in sides, hold the same person: a third of a
#: meter, as a side measures about 2.4 m of a person who stands (guess).
_SAME_PERSON_SIDES = 0.15
#: Somebody whose arm is up is looked at so many times as often as others (guess).
_RAISED_URGENCY = 4.0


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
        everyone: Whether each image is searched and everybody known read in it; otherwise
            `pose_search_period` and `pose_reads_per_frame` hold.

    Source: Bazarevsky et al., "BlazePose: On-device Real-time Body Pose Tracking", 2020.
    """

    def __init__(
        self, searcher: Searcher, reader: Reader, config: Config, *, everyone: bool
    ) -> None:
        super().__init__(config, everyone=everyone)
        self._searcher = searcher
        self._reader = reader

    @staticmethod
    def open(config: Config, store: ModelStore, *, everyone: bool) -> BodyFinder:
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
            everyone=everyone,
        )

    def reset(self) -> None:
        """Forget everybody."""
        super().reset()
        self._searches = 0
        self._alignment_px: FloatArray = np.zeros((0, 2, 2))
        self._waiting = Regions.none()  # found, but not yet looked at

    def _search(self, image: CameraImage) -> None:
        """Put the people of the next strip on the waiting list, unless they are known."""
        strips = upright_strips(image.width, image.height)
        window = strips[self._searches % len(strips)]
        self._searches += 1
        found = self._searcher.find(image.bgr, window, self._config.pose_confidence)
        known = Regions.concatenate(regions_from_alignment(self._alignment_px), self._waiting)
        apart = np.linalg.norm(found.center_px[:, None] - known.center_px[None], axis=-1)
        is_new = ~(apart < _SAME_PERSON_SIDES * found.side_px[:, None]).any(axis=1)
        room = max(self._config.max_hands - len(known), 0)
        self._waiting = Regions.concatenate(self._waiting, found[is_new][:room])

    def _look(self, image: CameraImage, known: Bodies, is_due: bool) -> Bodies:
        """Read as many people as the budget allows: new ones, then those most due."""
        if is_due:
            self._search(image)
        config = self._config
        reads = config.max_hands if self._everyone else config.pose_reads_per_frame
        new, self._waiting = self._waiting[:reads], self._waiting[reads:]
        due = self._most_due(known)[: reads - len(new)]
        others = np.setdiff1d(np.arange(len(known)), due)
        regions = Regions.concatenate(new, regions_from_alignment(self._alignment_px[due]))
        bodies, alignment_px = self._reader.read(image.bgr, regions)
        known = Bodies.concatenate(bodies, known[others])
        alignment_px = np.concatenate([alignment_px, self._alignment_px[others]])
        stays = np.isfinite(alignment_px).all(axis=(1, 2)) & (
            known.score >= config.pose_confidence
        )
        known, alignment_px = known[stays], alignment_px[stays]
        once = one_row_each(known)
        self._alignment_px = alignment_px[once]
        return known[once]

    def _most_due(self, known: Bodies) -> IntArray:
        raised, _ = judge_arms(known, self._config)
        urgency = known.age_s * np.where(raised.any(axis=1), _RAISED_URGENCY, 1.0)
        return np.argsort(-urgency, kind="stable")
