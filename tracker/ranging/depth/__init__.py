"""Depth image -> how far a hand's owner is, and who else stands there."""

from tracker.ranging.depth.bodies import DepthBodies, body_measurements, find_bodies
from tracker.ranging.depth.hand_depths import HandDepths, hand_depths
from tracker.ranging.depth.points import DepthPoints, depth_points
from tracker.ranging.depth.same_body import without_seen

__all__ = [
    "DepthBodies",
    "DepthPoints",
    "HandDepths",
    "body_measurements",
    "depth_points",
    "find_bodies",
    "hand_depths",
    "without_seen",
]
