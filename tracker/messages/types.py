"""Which message types are spoken, and how do their bytes become objects without ROS?

Names and fields are ROS 2's own (Jazzy); serialization is CDR, by rosbags.
"""

from __future__ import annotations

import struct
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from rosbags.serde import SerdeError
from rosbags.typesys import Stores, TypesysError, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from tracker.errors import RecordingError

BOOL = "std_msgs/msg/Bool"
STRING = "std_msgs/msg/String"
IMAGE = "sensor_msgs/msg/Image"
COMPRESSED_IMAGE = "sensor_msgs/msg/CompressedImage"
LASER_SCAN = "sensor_msgs/msg/LaserScan"
CAMERA_INFO = "sensor_msgs/msg/CameraInfo"
OCCUPANCY_GRID = "nav_msgs/msg/OccupancyGrid"
TF_MESSAGE = "tf2_msgs/msg/TFMessage"
TF_MESSAGE_ROS1 = "tf/msg/tfMessage"
POSE_STAMPED = "geometry_msgs/msg/PoseStamped"
DETECTIONS = "vision_msgs/msg/Detection3DArray"
MARKER_ARRAY = "visualization_msgs/msg/MarkerArray"

#: vision_msgs 4 is not among the types that rosbags brings along.
_VISION_MSGS = {
    "ObjectHypothesis": "string class_id\nfloat64 score\n",
    "ObjectHypothesisWithPose": (
        "vision_msgs/ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose\n"
    ),
    "BoundingBox3D": "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size\n",
    "Detection3D": (
        "std_msgs/Header header\n"
        "vision_msgs/ObjectHypothesisWithPose[] results\n"
        "vision_msgs/BoundingBox3D bbox\n"
        "string id\n"
    ),
    "Detection3DArray": "std_msgs/Header header\nvision_msgs/Detection3D[] detections\n",
}

#: What deserialization raises for bytes that are no such message.
MALFORMED = (SerdeError, struct.error, ValueError, IndexError, OverflowError, MemoryError)

# rosbags' descriptions of a field: a plain value, a message, a fixed array, a list.
_BASE, _NAME, _ARRAY = 1, 2, 3


class Encoded(NamedTuple):
    """A serialized message.

    Attributes:
        type_name: As ROS 2 writes it, `package/msg/Name`.
        cdr: The serialized message with its four bytes of encapsulation.
    """

    type_name: str
    cdr: bytes


@lru_cache(maxsize=1)
def typestore() -> Typestore:
    """Every type of ROS 2 Jazzy that rosbags knows, and vision_msgs."""
    store = get_typestore(Stores.ROS2_JAZZY)
    for name, definition in _VISION_MSGS.items():
        store.register(get_types_from_msg(definition, f"vision_msgs/msg/{name}"))
    return store


def build(type_name: str, **values: Any) -> Any:
    """A message object; fields that are not named are zero or empty, as in ROS."""
    fields = typestore().fielddefs[type_name][1]
    return typestore().types[type_name](
        **{name: values.pop(name) if name in values else _zero(kind) for name, kind in fields},
        **values,
    )


def serialize(message: Any) -> Encoded:
    """A message object of `build` as bytes."""
    type_name = message.__msgtype__
    return Encoded(type_name, bytes(typestore().serialize_cdr(message, type_name)))


def deserialize(type_name: str, cdr: bytes | memoryview) -> Any:
    """Bytes as a message object with ROS 2's field names.

    Raises:
        RecordingError: The type is unknown, or the bytes are no such message.
    """
    if type_name not in typestore().fielddefs:
        raise RecordingError(f"Message type {type_name!r} is unknown here.")
    try:
        return typestore().deserialize_cdr(cdr, type_name)
    except MALFORMED as error:
        raise RecordingError(
            f"{len(cdr)} bytes were received as {type_name}, but are not such a message ({error})."
        ) from error


def definition(type_name: str) -> str:
    """The type's definition followed by those of every type inside, as MCAP's `ros2msg` needs.

    Raises:
        RecordingError: The type is unknown.
    """
    try:
        text, _ = typestore().generate_msgdef(type_name, ros_version=2)
    except (TypesysError, KeyError) as error:
        raise RecordingError(f"Message type {type_name!r} is unknown here.") from error
    return text


@lru_cache(maxsize=64)
def type_hash(type_name: str) -> str:
    """The type's RIHS01 hash, by which ROS 2 (Iron and later) tells definitions apart."""
    return typestore().hash_rihs01(type_name)


@lru_cache(maxsize=64)
def _empty(type_name: str) -> Any:
    # Shared between messages, which nobody changes after they are built.
    return build(type_name, w=1.0) if type_name.endswith("/Quaternion") else build(type_name)


def _zero(kind: Any) -> Any:
    node, detail = kind
    if node == _NAME:
        return _empty(detail)
    if node == _BASE:
        return {"string": "", "bool": False, "float32": 0.0, "float64": 0.0}.get(detail[0], 0)
    (inner_node, inner), length = detail
    count = length if node == _ARRAY else 0
    if inner_node == _BASE and inner[0] != "string":
        return np.zeros(count, dtype={"octet": "uint8", "byte": "uint8"}.get(inner[0], inner[0]))
    return [_zero((inner_node, inner)) for _ in range(count)]
