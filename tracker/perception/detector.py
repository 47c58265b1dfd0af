"""The interface that every hand detector implements."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from tracker.config import Config
from tracker.containers import CameraImage, FloatArray, Hands, ImageArray, PerceptionWork


@runtime_checkable
class HandDetector(Protocol):
    """Finds hands in one picture after the other; `HandFinder` is the one that comes along.

    A detector of your own, around a pose model for example, fills `Hands.landmarks_px` in
    MediaPipe's order; `raise_rules.judge_raised` gives the verdict on them.
    """

    def find(self, image: CameraImage) -> Hands:
        """Every hand of the image, in pixels of the full image."""
        ...

    def reset(self) -> None:
        """Forget earlier images; the next one starts from nothing."""
        ...

    def configure(self, config: Config) -> None:
        """Take over changed parameters, from the next image on."""
        ...


@runtime_checkable
class PiecewiseDetector(HandDetector, Protocol):
    """A detector that searches the picture in pieces; its caller chooses where, and how many."""

    @property
    def work(self) -> PerceptionWork:
        """What the last image cost."""
        ...

    @property
    def seen(self) -> ImageArray | None:
        """The last image as the models saw it, shape (height, width, 3); None before the first.

        Dark and noisy pictures are cleared; other models may look at what came of it.
        """
        ...

    def expect(self, boxes_px: FloatArray) -> None:
        """Where raised hands are likelier in the next image: boxes of shape (E, 4), in pixels."""
        ...

    def set_budget(self, runs: int | None) -> None:
        """Set the number of model runs per image from now on; None means as configured."""
        ...
