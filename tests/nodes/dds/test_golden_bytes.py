"""What goes over the wire, against cyclonedds' own serializer and fields spelled out here.

A wrong field under the right name gives garbage on the other side, without an error.
"""

import re

import numpy as np
import pytest

pytest.importorskip("cyclonedds", reason="the extra dds is not installed")

from cyclonedds.idl import make_idl_struct, types

from nodes.shared.diagnostics import Status, encode_statuses
from tracker.camera import CameraModel
from tracker.containers import CameraImage, Pose, Scan, Tracks
from tracker.geometry import RigidTransform
from tracker.messages import CameraInfo, encode, encode_markers
from tracker.messages.types import build, deserialize, serialize
from tracker.transforms import StampedTransform

#: The interfaces of ROS 2 Jazzy as far as this node speaks them, in the order of their fields.
INTERFACES = """
builtin_interfaces/Time: int32 sec, uint32 nanosec
builtin_interfaces/Duration: int32 sec, uint32 nanosec
std_msgs/Header: Time stamp, string frame_id
std_msgs/Bool: bool data
std_msgs/ColorRGBA: float32 r, float32 g, float32 b, float32 a
geometry_msgs/Point: float64 x, float64 y, float64 z
geometry_msgs/Vector3: float64 x, float64 y, float64 z
geometry_msgs/Quaternion: float64 x, float64 y, float64 z, float64 w
geometry_msgs/Pose: Point position, Quaternion orientation
geometry_msgs/PoseStamped: Header header, Pose pose
geometry_msgs/PoseWithCovariance: Pose pose, float64[36] covariance
geometry_msgs/Transform: Vector3 translation, Quaternion rotation
geometry_msgs/TransformStamped: Header header, string child_frame_id, Transform transform
tf2_msgs/TFMessage: TransformStamped[] transforms
sensor_msgs/Image: Header header, uint32 height, uint32 width, string encoding, uint8 is_bigendian, uint32 step, uint8[] data
sensor_msgs/CompressedImage: Header header, string format, uint8[] data
sensor_msgs/LaserScan: Header header, float32 angle_min, float32 angle_max, float32 angle_increment, float32 time_increment, float32 scan_time, float32 range_min, float32 range_max, float32[] ranges, float32[] intensities
sensor_msgs/RegionOfInterest: uint32 x_offset, uint32 y_offset, uint32 height, uint32 width, bool do_rectify
sensor_msgs/CameraInfo: Header header, uint32 height, uint32 width, string distortion_model, float64[] d, float64[9] k, float64[9] r, float64[12] p, uint32 binning_x, uint32 binning_y, RegionOfInterest roi
vision_msgs/ObjectHypothesis: string class_id, float64 score
vision_msgs/ObjectHypothesisWithPose: ObjectHypothesis hypothesis, PoseWithCovariance pose
vision_msgs/BoundingBox3D: Pose center, Vector3 size
vision_msgs/Detection3D: Header header, ObjectHypothesisWithPose[] results, BoundingBox3D bbox, string id
vision_msgs/Detection3DArray: Header header, Detection3D[] detections
visualization_msgs/UVCoordinate: float32 u, float32 v
visualization_msgs/MeshFile: string filename, uint8[] data
visualization_msgs/Marker: Header header, string ns, int32 id, int32 type, int32 action, Pose pose, Vector3 scale, ColorRGBA color, Duration lifetime, bool frame_locked, Point[] points, ColorRGBA[] colors, string texture_resource, CompressedImage texture, UVCoordinate[] uv_coordinates, string text, string mesh_resource, MeshFile mesh_file, bool mesh_use_embedded_materials
visualization_msgs/MarkerArray: Marker[] markers
diagnostic_msgs/KeyValue: string key, string value
diagnostic_msgs/DiagnosticStatus: uint8 level, string name, string message, string hardware_id, KeyValue[] values
diagnostic_msgs/DiagnosticArray: Header header, DiagnosticStatus[] status
rosgraph_msgs/Clock: Time clock
rcl_interfaces/Log: Time stamp, uint8 level, string name, string msg, string file, string function, uint32 line
rcl_interfaces/ParameterValue: uint8 type, bool bool_value, int64 integer_value, float64 double_value, string string_value, uint8[] byte_array_value, bool[] bool_array_value, int64[] integer_array_value, float64[] double_array_value, string[] string_array_value
rcl_interfaces/Parameter: string name, ParameterValue value
rcl_interfaces/ParameterEvent: Time stamp, string node, Parameter[] new_parameters, Parameter[] changed_parameters, Parameter[] deleted_parameters
rmw_dds_common/Gid: uint8[16] data
rmw_dds_common/NodeEntitiesInfo: string node_namespace, string node_name, Gid[] reader_gid_seq, Gid[] writer_gid_seq
rmw_dds_common/ParticipantEntitiesInfo: Gid gid, NodeEntitiesInfo[] node_entities_info_seq
"""  # noqa: E501
# Bounded strings (rmw_dds_common has two) look like others on the wire.


def idl_types():
    known = {
        name: getattr(types, name)
        for name in ("uint8", "int32", "uint32", "int64", "float32", "float64")
    } | {"bool": bool, "string": str}
    for line in INTERFACES.strip().splitlines():
        full, fields = line.split(": ")
        package, name = full.split("/")
        known[name] = make_idl_struct(
            f"{name}_",
            f"{package}.msg.dds_.{name}_",
            dict(map(field_of(known), fields.split(", "))),
        )
    return known


def field_of(known):
    def field(text):
        kind, suffix, name = re.fullmatch(r"(\w+)((?:\[\d*\])?) (\w+)", text).groups()
        inner = known[kind]
        if suffix == "[]":
            inner = types.sequence[inner]
        elif suffix:
            inner = types.array[inner, int(suffix[1:-1])]
        return name, inner

    return field


IDL = idl_types()


def golden(name, value):
    return as_idl(IDL[name], value).serialize(use_version_2=False)


def as_idl(kind, value):
    """Dictionaries as cyclonedds' objects; what is not named is zero or empty."""
    hints = kind.__annotations__
    return kind(**{field: as_field(hints[field], value.get(field)) for field in hints})


def as_field(hint, value):
    if hasattr(hint, "__idl__"):
        return as_idl(hint, value or {})
    if hint in (bool, str):
        return hint() if value is None else value
    metadata = getattr(hint, "__metadata__", [None])[0]
    if isinstance(metadata, types.sequence):
        return [as_field(metadata.subtype, item) for item in value or []]
    if isinstance(metadata, types.array):
        items = [0] * metadata.length if value is None else value
        return [as_field(metadata.subtype, item) for item in items]
    return 0 if value is None else value


STAMP_NS = 1_700_000_000_250_000_000
STAMP = {"sec": 1_700_000_000, "nanosec": 250_000_000}
HEADER = {"stamp": STAMP, "frame_id": "map"}
PIXELS = np.arange(18, dtype=np.uint8).reshape(2, 3, 3)
QUATERNION = {"x": 0.5, "y": -0.5, "z": 0.5, "w": 0.5}
UPRIGHT = {"w": 1.0}


def xyz(x, y, z):
    return {"x": x, "y": y, "z": z}


def a_track():
    covariance = np.diag([0.04, 0.01, 1.0, 1.0])
    covariance[0, 1] = covariance[1, 0] = 0.005
    none = Tracks.none(STAMP_NS)
    values = {
        "id": np.array([7]),
        "mean": np.array([[1.5, -2.0, 0.5, -0.25]]),
        "covariance": covariance[None],
        "existence": np.array([0.75]),
        "raised": np.array([True]),
        "raised_since_ns": np.array([STAMP_NS - 1_500_000_000]),
        "confirmed": np.array([True]),
        "age_s": np.array([2.5]),
    }
    return type(none)(
        **{
            name: values.get(name, fill(getattr(none, name)))
            for name in none.__dataclass_fields__
            if name not in ("stamp_ns", "selected_id", "refused")
        },
        stamp_ns=STAMP_NS,
        selected_id=7,
    )


def fill(empty):
    return np.zeros((1, *empty.shape[1:]), dtype=empty.dtype)


def detection():
    place, velocity = [0.0] * 36, [0.0] * 36
    place[0], place[1], place[6], place[7] = 0.04, 0.005, 0.005, 0.01
    place[14], place[21], place[28], place[35] = 0.05**2, 0.2**2, 0.2**2, np.pi**2 / 3
    velocity[0] = velocity[7] = 1.0
    floor = {"position": xyz(1.5, -2.0, 0.0), "orientation": UPRIGHT}
    speed = {"position": xyz(0.5, -0.25, 0.0), "orientation": UPRIGHT}
    body = {"position": xyz(1.5, -2.0, 0.85), "orientation": UPRIGHT}
    words = ["hand_raised", "age_s/2.500", "raised_since/1699999998.750000000"]
    said = [(word, floor, place) for word in words] + [("velocity", speed, velocity)]
    return {
        "header": HEADER,
        "results": [
            {
                "hypothesis": {"class_id": word, "score": 0.75},
                "pose": {"pose": pose, "covariance": covariance},
            }
            for word, pose, covariance in said
        ],
        "bbox": {"center": body, "size": xyz(0.5, 0.5, 1.7)},
        "id": "7",
    }


CASES = {
    "Bool": (encode(True), {"data": True}),
    "PoseStamped": (
        encode(Pose(STAMP_NS, "map", (1.0, -2.5, 0.125), (0.5, -0.5, 0.5, 0.5))),
        {"header": HEADER, "pose": {"position": xyz(1.0, -2.5, 0.125), "orientation": QUATERNION}},
    ),
    "Image": (
        encode(CameraImage(STAMP_NS, "map", PIXELS)),
        {
            "header": HEADER, "height": 2, "width": 3, "encoding": "bgr8", "step": 9,
            "data": list(range(18)),
        },
    ),
    "LaserScan": (
        encode(Scan(STAMP_NS, "map", -0.5, 0.25, 0.125, 12.5, np.array([1.0, np.inf, 2.5]))),
        {
            "header": HEADER, "angle_min": -0.5, "angle_max": 0.0, "angle_increment": 0.25,
            "range_min": 0.125, "range_max": 12.5, "ranges": [1.0, float("inf"), 2.5],
        },
    ),
    "CameraInfo": (
        encode(CameraInfo(STAMP_NS, "map", 640, 480, CameraModel(460.0, 461.0, 320.0, 240.5))),
        {
            "header": HEADER, "height": 480, "width": 640, "distortion_model": "plumb_bob",
            "d": [0.0] * 5,
            "k": [460.0, 0.0, 320.0, 0.0, 461.0, 240.5, 0.0, 0.0, 1.0],
            "r": [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            "p": [460.0, 0.0, 320.0, 0.0, 0.0, 461.0, 240.5, 0.0, 0.0, 0.0, 1.0, 0.0],
        },
    ),
    "TFMessage": (
        encode(
            StampedTransform(
                STAMP_NS, "map", "base", RigidTransform((1.0, 2.0, 3.0), (0.5, -0.5, 0.5, 0.5))
            )
        ),
        {
            "transforms": [
                {
                    "header": HEADER, "child_frame_id": "base",
                    "transform": {"translation": xyz(1.0, 2.0, 3.0), "rotation": QUATERNION},
                }
            ]
        },
    ),
    "Detection3DArray": (encode(a_track()), {"header": HEADER, "detections": [detection()]}),
    "DiagnosticArray": (
        encode_statuses(
            [Status("images", 2, "missing", {"topic": "/image_raw"})], STAMP_NS, "hand_detector"
        ),
        {
            "header": {"stamp": STAMP},
            "status": [
                {
                    "level": 2, "name": "hand_detector: images", "message": "missing",
                    "hardware_id": "hand_detector",
                    "values": [{"key": "topic", "value": "/image_raw"}],
                }
            ],
        },
    ),
    "Clock": (
        serialize(
            build("rosgraph_msgs/msg/Clock", clock=build("builtin_interfaces/msg/Time", **STAMP))
        ),
        {"clock": STAMP},
    ),
    "Log": (
        serialize(build("rcl_interfaces/msg/Log", level=20, name="a", msg="bcd")),
        {"level": 20, "name": "a", "msg": "bcd"},
    ),
    "ParameterEvent": (
        serialize(
            build(
                "rcl_interfaces/msg/ParameterEvent",
                node="/n",
                changed_parameters=[
                    build(
                        "rcl_interfaces/msg/Parameter",
                        name="p",
                        value=build("rcl_interfaces/msg/ParameterValue", type=3, double_value=8.0),
                    )
                ],
            )
        ),
        {
            "node": "/n",
            "changed_parameters": [{"name": "p", "value": {"type": 3, "double_value": 8.0}}],
        },
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_messages_are_serialized_as_cyclone_dds_does(name):
    message, value = CASES[name]
    assert message.type_name.endswith(f"/{name}")
    assert without_padding(message.cdr) == without_padding(golden(name, value))


def test_markers_are_serialized_as_cyclone_dds_does():
    """Their colors and ellipses are of no interest here; their fields are."""
    message = encode_markers(
        a_track(), approach=Pose(STAMP_NS, "map", (1.0, 2.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    )
    said = deserialize(*message)
    assert len(said.markers) == 5
    assert without_padding(message.cdr) == without_padding(golden("MarkerArray", plain(said)))


def test_the_graphs_message_is_serialized_as_cyclone_dds_does(make_node):
    from nodes.dds.node import _gid

    node = make_node("hand_detector", namespace="/robot")
    gid = list(node._participant.guid.bytes)
    entities = build(
        "rmw_dds_common/msg/NodeEntitiesInfo",
        node_namespace="/robot",
        node_name="hand_detector",
        writer_gid_seq=[_gid(node._participant)],
    )
    message = build(
        "rmw_dds_common/msg/ParticipantEntitiesInfo",
        gid=_gid(node._participant),
        node_entities_info_seq=[entities],
    )
    value = {
        "gid": {"data": gid},
        "node_entities_info_seq": [
            {
                "node_namespace": "/robot",
                "node_name": "hand_detector",
                "writer_gid_seq": [{"data": gid}],
            }
        ],
    }
    assert serialize(message).cdr == golden("ParticipantEntitiesInfo", value)


def plain(value):
    if hasattr(value, "__msgtype__"):
        names = [name for name in value.__dataclass_fields__ if name != "__msgtype__"]
        return {name: plain(getattr(value, name)) for name in names}
    if isinstance(value, (list, np.ndarray)):
        return [plain(item) for item in value]
    return value.item() if isinstance(value, np.generic) else value


def without_padding(cdr):
    """Messages are words of four bytes on the wire; where the last one is filled up differs."""
    return cdr.ljust(len(cdr) + -len(cdr) % 4, b"\0")
