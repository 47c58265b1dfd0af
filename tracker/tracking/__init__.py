"""Measurements -> Tracks: predict, gate, associate, update, life cycle, streaks, selection."""

from tracker.tracking.person_tracker import PersonTracker
from tracker.tracking.poses import approach_pose, customer_pose
from tracker.tracking.view import View

__all__ = ["PersonTracker", "View", "approach_pose", "customer_pose"]
