"""Who around the robot raises a hand, where each of them stands in the map, who is served next."""

from tracker.config import Config
from tracker.containers import FrameResult, Hands, Measurements, Pose, Scan, Tracks

__all__ = ["Config", "FrameResult", "Hands", "Measurements", "Pose", "Scan", "Tracks"]
