"""Tracks -> who waits for service, who is served next, where the robot should look and drive."""

from tracker.service.call_keeper import CallKeeper
from tracker.service.commands import Answer, Command, Verb
from tracker.service.poses import approach_pose, call_pose, customer_pose

__all__ = [
    "Answer",
    "CallKeeper",
    "Command",
    "Verb",
    "approach_pose",
    "call_pose",
    "customer_pose",
]
