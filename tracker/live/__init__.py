"""The pipeline at the pace of the world: cameras, streams, and recordings or scenes as if live."""

from tracker.live.camera import CameraStream
from tracker.live.run import run_live
from tracker.live.sources import live_events

__all__ = ["CameraStream", "live_events", "run_live"]
