"""What both nodes share knows neither ROS nor DDS, and the tracker is below it."""

import ast
from pathlib import Path

import pytest

NODES = Path(__file__).parents[2] / "nodes"
WIRES = {
    "rclpy", "tf2_ros", "cyclonedds", "sensor_msgs", "std_msgs", "std_srvs", "geometry_msgs",
    "vision_msgs", "visualization_msgs", "diagnostic_msgs", "rcl_interfaces", "tf2_msgs",
    "nav_msgs",
}  # fmt: skip


SHARED = sorted((NODES / "shared").glob("*.py"))


@pytest.mark.parametrize("path", SHARED, ids=lambda path: path.name)
def test_the_shared_part_speaks_no_wire(path):
    tree = ast.parse(path.read_text(encoding="utf-8"))
    imported = {
        alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.Import)
        for alias in node.names
    } | {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    assert not {module.split(".")[0] for module in imported} & WIRES
    ours = {module for module in imported if module.startswith("nodes.")}
    assert {module for module in ours if not module.startswith("nodes.shared.")} == set()


@pytest.mark.parametrize("path", sorted(NODES.rglob("*.py")), ids=lambda path: path.name)
def test_no_node_needs_the_command_line(path):
    """`raised-hand play` needs nodes, so that the other way would be a circle."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    modules = [node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    assert not [module for module in modules if module.startswith("tracker.cli")]
