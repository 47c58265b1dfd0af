"""Who was in the picture, and who still is? What finders of bodies do from image to image."""

from __future__ import annotations

from abc import ABC, abstractmethod

from tracker.config import Config
from tracker.containers import CameraImage
from tracker.perception.bodies import Bodies
from tracker.perception.pictures import continues


class KnownBodies(ABC):
    """A `BodyDetector` but for the looking: `_look` is left to the models.

    Args:
        config: The pose group.
    """

    _last: CameraImage | None
    _known: Bodies

    def __init__(self, config: Config) -> None:
        self._config = config
        self.reset()

    def find(self, image: CameraImage) -> Bodies:
        """Everybody known; those looked at in this very image have age 0.

        A stamp that jumps back, another frame_id or another size of the image starts anew.
        """
        if self._last is None or not continues(self._last, image):
            self.reset()
        passed_ns = image.stamp_ns - (self._last or image).stamp_ns
        self._last = image
        known = self._known.grown_older(passed_ns / 1e9)
        self._known = self._look(image, known)
        return self._known

    def reset(self) -> None:
        """Forget everybody."""
        self._last = None
        self._known = Bodies.none()

    def configure(self, config: Config) -> None:
        """Take over changed parameters, from the next image on; the models stay."""
        self._config = config

    @abstractmethod
    def _look(self, image: CameraImage, known: Bodies) -> Bodies:
        """Who is known with this image."""
