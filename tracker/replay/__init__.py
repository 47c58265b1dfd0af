"""A recording through the pipeline, and what it leaves behind."""

from tracker.replay.run import Replay, Watcher, replay

__all__ = ["Replay", "Watcher", "replay"]
