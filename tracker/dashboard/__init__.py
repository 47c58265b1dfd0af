"""One page in a browser: camera, room, waiting list, timeline, health, parameters."""

from tracker.dashboard.dashboard import Dashboard, Steering
from tracker.dashboard.server import DashboardServer

__all__ = ["Dashboard", "DashboardServer", "Steering"]
