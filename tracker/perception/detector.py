"""The interface that every hand detector implements."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

import numpy as np

from tracker.config import Config
from tracker.containers import CameraImage, FloatArray, Hands, PerceptionWork


@dataclass(frozen=True, slots=True, eq=False)
class Hints:
    """What may help with one image; a detector may leave any of it aside.

    Attributes:
        expected_px: Shape (E, 4): boxes in which raised hands are likelier, in pixels.
        model_runs: How many model runs the image may take; None is as configured.
        suggested_px: Shape (G, 21, 2): landmarks of hands that may be there, to be looked at
            without a search.
        spared: So many places less are searched, down to one.
    """

    expected_px: FloatArray = field(default_factory=lambda: np.zeros((0, 4)))
    model_runs: int | None = None
    suggested_px: FloatArray = field(default_factory=lambda: np.zeros((0, 21, 2)))
    spared: int = 0


NO_HINTS = Hints()


@runtime_checkable
class HandDetector(Protocol):
    """Finds hands in one picture after the other; `HandFinder` is the one that comes along.

    A detector of your own, around a pose model for example, fills `Hands.landmarks_px` in
    MediaPipe's order; `raise_rules.judge_raised` gives the verdict on them.
    """

    def find(self, image: CameraImage, hints: Hints = NO_HINTS) -> Hands:
        """Every hand of the image, in pixels of the full image."""
        ...

    @property
    def work(self) -> PerceptionWork | None:
        """What the last image cost; None where nobody counts."""
        ...

    def reset(self) -> None:
        """Forget earlier images; the next one starts from nothing."""
        ...

    def configure(self, config: Config) -> None:
        """Take over changed parameters, from the next image on."""
        ...
