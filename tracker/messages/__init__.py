"""Containers as ROS 2 messages and back, as pure functions over bytes: no ROS needed.

Recordings, the rclpy node (raw subscriptions, bytes published) and the DDS node share them.
"""

from tracker.messages.decode import DECODABLE, Event, decode, events_from_message
from tracker.messages.encode import CameraInfo, Encodable, encode
from tracker.messages.markers import encode_markers
from tracker.messages.people import encode_tracks
from tracker.messages.types import Encoded, definition, type_hash
from tracker.messages.waiting import encode_raised, encode_waiting_list

__all__ = [
    "DECODABLE",
    "CameraInfo",
    "Encodable",
    "Encoded",
    "Event",
    "decode",
    "definition",
    "encode",
    "encode_markers",
    "encode_raised",
    "encode_tracks",
    "encode_waiting_list",
    "events_from_message",
    "type_hash",
]
