"""Who around the robot raises a hand, where each of them stands in the map, who is served next."""

from typing import TYPE_CHECKING, Any

from tracker.config import Config
from tracker.containers import (
    CameraImage,
    FrameResult,
    Hands,
    Measurements,
    Pose,
    Scan,
    Tracks,
)
from tracker.tracking import PersonTracker

if TYPE_CHECKING:
    from tracker.pipeline import Pipeline

__all__ = [
    "CameraImage",
    "Config",
    "FrameResult",
    "Hands",
    "Measurements",
    "PersonTracker",
    "Pipeline",
    "Pose",
    "Scan",
    "Tracks",
]


def __getattr__(name: str) -> Any:
    """`Pipeline` brings perception along, which not everyone who tracks has installed."""
    if name == "Pipeline":
        from tracker.pipeline import Pipeline

        return Pipeline
    raise AttributeError(f"module 'tracker' has no attribute {name!r}")
