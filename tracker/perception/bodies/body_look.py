"""Who is in this part of the picture, and how does somebody known hold their arms now?"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from tracker.config import Config
from tracker.containers import ImageArray
from tracker.perception.bodies.bodies import Bodies
from tracker.perception.bodies.pose_landmarks import PoseReader
from tracker.perception.models import ModelStore
from tracker.perception.models.sessions import open_session
from tracker.perception.pictures import Window, upright_strips
from tracker.perception.regions import regions_from_alignment
from tracker.perception.single_shot import POSE_LAYERS, SingleShot

#: Side of the square that the detector sees.
_SEARCH_PX = 224
#: People of a window whose joints are read, the surest first.
_READS = 2
#: Two regions whose centers are closer than this, in sides, hold the same person: a third of a
#: meter, as a side measures about 2.4 m of a person who stands (guess).
_SAME_PERSON_SIDES = 0.15
_NOBODY = Bodies.none()


class BodyLook(Protocol):
    """The interface that every pose model implements."""

    def windows(self, width: int, height: int) -> list[Window]:
        """The parts of a picture of this size that must be searched to see everybody."""
        ...

    def around(
        self, bgr: ImageArray, window: Window, known: Bodies = _NOBODY, most: int = _READS
    ) -> Bodies:
        """Everybody whom it sees in a window of the picture.

        Args:
            bgr: Shape (height, width, 3), the full image.
            window: Left, top, width, height of the part, inside the picture.
            known: Who need not be told again.
            most: So many people are enough, where each costs time.

        Raises:
            ModelFileError: The model fails.
        """
        ...

    def again(self, bgr: ImageArray, known: Bodies) -> Bodies:
        """Somebody known, as they are in this picture; nobody where they are gone."""
        ...

    def configure(self, config: Config) -> None:
        """Take over changed parameters; the model stays."""
        ...


class MediapipeLook:
    """MediaPipe's pose models; everybody known is read without a search.

    Args:
        searcher: Finds people.
        reader: Reads their joints.
        config: The pose group.

    Source: Bazarevsky et al., "BlazePose: On-device Real-time Body Pose Tracking", 2020.
    """

    def __init__(self, searcher: SingleShot, reader: PoseReader, config: Config) -> None:
        self._searcher = searcher
        self._reader = reader
        self.configure(config)

    @staticmethod
    def open(store: ModelStore, config: Config) -> MediapipeLook:
        """The pose models of a store; raises as `open_session`."""
        detector, landmarks = (
            open_session(
                store,
                name,
                threads=config.inference_threads,
                fixed_sizes={"batch": 1},
                provider=config.execution_provider,
                numbers=config.model_numbers,
            )
            for name in ("pose_detection", "pose_landmark_full")
        )
        search = SingleShot(detector, _SEARCH_PX, POSE_LAYERS, black=-1.0)
        return MediapipeLook(search, PoseReader(landmarks), config)

    def windows(self, width: int, height: int) -> list[Window]:
        """Upright strips: the detector sees the most prominent people of a picture alone."""
        return upright_strips(width, height)

    def around(
        self, bgr: ImageArray, window: Window, known: Bodies = _NOBODY, most: int = _READS
    ) -> Bodies:
        """People of a window who are not known, the surest of them."""
        people = self._searcher.find(bgr, self._score_min, window=window)
        found = regions_from_alignment(people.keypoints_px[:, :2])
        there_px = regions_from_alignment(known.alignment_px).center_px
        apart = np.linalg.norm(found.center_px[:, None] - there_px[None], axis=-1)
        is_new = ~(apart < _SAME_PERSON_SIDES * found.side_px[:, None]).any(axis=1)
        return self._believed(self._reader.read(bgr, found[is_new][:most]))

    def again(self, bgr: ImageArray, known: Bodies) -> Bodies:
        """Update the poses of known people."""
        return self._believed(self._reader.read(bgr, regions_from_alignment(known.alignment_px)))

    def configure(self, config: Config) -> None:
        """Take over changed parameters; the models stay."""
        self._score_min = config.pose_confidence

    def _believed(self, bodies: Bodies) -> Bodies:
        return bodies[bodies.score >= self._score_min]
