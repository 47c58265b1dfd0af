"""The data types that are passed between the rooms: typed, frozen containers.

Row i of every array of a batch is the same thing (the same hand, measurement, person). Arrays are
made read-only, stamps are integer nanoseconds, frames and units stand in the names.
"""

from tracker.containers.arrays import (
    BoolArray,
    FloatArray,
    ImageArray,
    IntArray,
    check_stamp,
)
from tracker.containers.hands import Hands, Refusal
from tracker.containers.located_scan import LocatedScan
from tracker.containers.measurements import Measurements
from tracker.containers.occupancy_grid import LocatedMap, OccupancyGrid
from tracker.containers.results import FrameResult, PerceptionWork, Pose, Truth
from tracker.containers.sensor_kind import SensorKind
from tracker.containers.sensors import CameraImage, DepthArray, DepthImage, Scan, depth_in_meters
from tracker.containers.tracks import Tracks
from tracker.containers.view import View
from tracker.containers.waiting_list import Caller, CallState, WaitingList

__all__ = [
    "BoolArray",
    "CallState",
    "Caller",
    "CameraImage",
    "DepthArray",
    "DepthImage",
    "FloatArray",
    "FrameResult",
    "Hands",
    "ImageArray",
    "IntArray",
    "LocatedMap",
    "LocatedScan",
    "Measurements",
    "OccupancyGrid",
    "PerceptionWork",
    "Pose",
    "Refusal",
    "Scan",
    "SensorKind",
    "Tracks",
    "Truth",
    "View",
    "WaitingList",
    "check_stamp",
    "depth_in_meters",
]
