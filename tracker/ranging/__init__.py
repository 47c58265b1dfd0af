"""Scan -> how far a hand's owner is, and who else stands there."""

from tracker.ranging.bearing_span import bearing_span_rad
from tracker.ranging.expected_hands import expected_hands
from tracker.ranging.measuring import measure_people, scan_people
from tracker.ranging.memory import Memory
from tracker.ranging.ownership import Ownership
from tracker.ranging.postures import Postures
from tracker.ranging.rays import body_pose, hand_rays
from tracker.ranging.scan.background import Background
from tracker.ranging.scan.beams import beam_index, median_range
from tracker.ranging.scan.locating import locate_scan
from tracker.ranging.scan.odd_scans import mend_scan
from tracker.ranging.scan.people import PersonClusters, find_people
from tracker.ranging.scan.room_map import RoomMap

__all__ = [
    "Background",
    "Memory",
    "Ownership",
    "PersonClusters",
    "Postures",
    "RoomMap",
    "beam_index",
    "bearing_span_rad",
    "body_pose",
    "expected_hands",
    "find_people",
    "hand_rays",
    "locate_scan",
    "measure_people",
    "median_range",
    "mend_scan",
    "scan_people",
]
