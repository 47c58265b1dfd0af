"""Measurements -> Tracks: predict, gate, associate, update, life cycle, streaks."""

from tracker.containers import View
from tracker.tracking.person_tracker import PersonTracker

__all__ = ["PersonTracker", "View"]
