"""What must a detector of people be able to do? The one interface of all pose models."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from tracker.config import Config
from tracker.containers import CameraImage
from tracker.perception.bodies import Bodies


@runtime_checkable
class BodyDetector(Protocol):
    """Finds people and their joints in one picture after the other, in its own time."""

    def find(self, image: CameraImage) -> Bodies:
        """Everybody known, in pixels of the full image; who was looked at just now has age 0."""
        ...

    def reset(self) -> None:
        """Forget earlier images; the next one starts from nothing."""
        ...

    def configure(self, config: Config) -> None:
        """Take over changed parameters, from the next image on."""
        ...
