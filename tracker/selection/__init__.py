"""Tracks -> who is served, and where the robot should look and drive."""

from tracker.selection.poses import approach_pose, customer_pose
from tracker.selection.selector import Selector

__all__ = ["Selector", "approach_pose", "customer_pose"]
