import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from tracker.errors import RecordingError
from tracker.messages import definition, type_hash
from tracker.messages.types import build, deserialize, serialize, typestore


def test_type_hashes_are_those_of_ros_2_jazzy():
    # Published with ROS 2 Jazzy, in share/<package>/msg/<Name>.json.
    assert type_hash("std_msgs/msg/Bool") == (
        "RIHS01_feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9"
    )
    assert type_hash("sensor_msgs/msg/LaserScan") == (
        "RIHS01_64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828"
    )


def test_a_definition_holds_every_type_inside():
    text = definition("vision_msgs/msg/Detection3DArray")
    for name in ("Detection3D", "ObjectHypothesisWithPose", "ObjectHypothesis", "BoundingBox3D"):
        assert f"MSG: vision_msgs/{name}\n" in text
    parsed = get_types_from_msg(text, "vision_msgs/msg/Detection3DArray")
    assert "geometry_msgs/msg/PoseWithCovariance" in parsed


def test_the_stock_types_are_left_alone():
    stock = get_typestore(Stores.ROS2_JAZZY)
    assert stock.fielddefs.items() <= typestore().fielddefs.items()


def test_fields_that_are_not_named_are_zero_as_in_ros():
    pose = build("geometry_msgs/msg/PoseWithCovariance")
    assert pose.covariance.tolist() == [0.0] * 36
    assert pose.pose.orientation.w == 1.0
    marker = build("visualization_msgs/msg/Marker", text="x")
    assert (marker.text, marker.ns, list(marker.points)) == ("x", "", [])
    assert deserialize(*serialize(marker)).text == "x"


def test_misspelled_fields_are_refused():
    with pytest.raises(TypeError, match="dta"):
        build("std_msgs/msg/Bool", dta=True)


def test_unknown_types_have_no_definition():
    with pytest.raises(RecordingError, match="my_msgs/msg/Own"):
        definition("my_msgs/msg/Own")
