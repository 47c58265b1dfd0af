"""The node without ROS, seen from ROS 2."""

import pytest

pytest.importorskip("rclpy", reason="rclpy cannot be imported: no ROS 2 is sourced here")
pytest.importorskip("cyclonedds", reason="the extra dds is not installed")

pytestmark = [pytest.mark.slow, pytest.mark.model]

#: Sooner than the node says again, every 8 s, that it is there.
LOOK_FOR_THE_NODE = """
import time, rclpy
rclpy.init()
node, end = rclpy.create_node("latecomer"), time.monotonic() + 3
while ("hand_detector", "/") not in node.get_node_names_and_namespaces():
    assert time.monotonic() < end, node.get_node_names()
"""


def test_who_comes_later_finds_it_at_once(run, start_node):
    node = start_node(module="nodes.dds_hand_detector")
    for _ in range(2):
        assert run("-c", LOOK_FOR_THE_NODE, name="latecomer").wait(30.0) == 0
    assert node.poll() is None
