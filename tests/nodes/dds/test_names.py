import pytest

pytest.importorskip("cyclonedds", reason="the extra dds is not installed")

from nodes.dds.names import Names, dds_type_name, ros_type_name
from tracker.errors import ConfigError


@pytest.mark.parametrize(
    ("name", "full"),
    [
        ("scan", "/robot/scan"),
        ("/scan", "/scan"),
        ("~/tracks", "/robot/hand_detector/tracks"),
        ("front/image_raw", "/robot/front/image_raw"),
    ],
)
def test_names_are_expanded_as_ros_does(name, full):
    assert Names("hand_detector", "robot/").resolve(name) == full


def test_remapping_compares_full_names():
    names = Names("d", "/r", ["image_raw:=/camera/image", "/r/scan:=lidar", "~/tracks:=people"])
    assert names.resolve("/r/image_raw") == "/camera/image"
    assert names.resolve("scan") == "/r/lidar"
    assert names.resolve("/r/d/tracks") == "/r/people"
    assert names.resolve("/image_raw") == "/image_raw"


def test_node_and_namespace_can_be_remapped():
    names = Names("d", "/", ["__node:=watcher", "__ns:=/r2", "~/tracks:=/people"])
    assert names.full_node_name == "/r2/watcher"
    assert names.resolve("/r2/watcher/tracks") == "/people"


@pytest.mark.parametrize("rule", ["a", "a:=", ":=b", "a:=/1b", "__node:=a/b", "__ns:=a-b"])
def test_a_rule_that_is_none_is_refused(rule):
    with pytest.raises(ConfigError):
        Names("d", "/", [rule])


def test_types_have_other_names_in_dds():
    assert dds_type_name("std_srvs/srv/Trigger_Request") == "std_srvs::srv::dds_::Trigger_Request_"
    assert ros_type_name("sensor_msgs::msg::dds_::Image_") == "sensor_msgs/msg/Image"
    assert ros_type_name("HelloWorldData::Msg") is None
