"""Who around the robot raises a hand, where each of them stands in the map, who is served next."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
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
    from tracker.pipeline import Pipeline
    from tracker.tracking import PersonTracker

    __version__: str

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

_HOMES = {"Config": "config", "Pipeline": "pipeline", "PersonTracker": "tracking"}


def __getattr__(name: str) -> Any:
    """Each brings along only what it needs, when it is asked for: nobody waits for the others."""
    if name == "__version__":  # pyproject.toml's
        from importlib.metadata import version

        return version("raised-hand-tracker")
    if name in __all__:
        return getattr(import_module(f"tracker.{_HOMES.get(name, 'containers')}"), name)
    raise AttributeError(f"module 'tracker' has no attribute {name!r}")
