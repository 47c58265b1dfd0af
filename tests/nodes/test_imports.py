"""What both nodes share knows neither ROS nor DDS, and the tracker is below it."""

import ast
from pathlib import Path

import pytest

NODES = Path(__file__).parents[2] / "nodes"
SHARED = (
    "call_desk", "core", "diagnostics", "fault_log", "header_peek", "image_silence", "inbox",
    "kept_calls", "link", "outputs", "page", "parameters", "qos", "topics", "work_budget",
)  # fmt: skip
WIRES = {
    "rclpy", "tf2_ros", "cyclonedds", "sensor_msgs", "std_msgs", "std_srvs", "geometry_msgs",
    "vision_msgs", "visualization_msgs", "diagnostic_msgs", "rcl_interfaces", "tf2_msgs",
    "nav_msgs",
}  # fmt: skip


@pytest.mark.parametrize("name", SHARED)
def test_the_shared_part_speaks_no_wire(name):
    tree = ast.parse((NODES / f"{name}.py").read_text(encoding="utf-8"))
    imported = {
        alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.Import)
        for alias in node.names
    } | {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    assert not {module.split(".")[0] for module in imported} & WIRES
    ours = {module for module in imported if module.startswith("nodes.")}
    assert ours <= {f"nodes.{other}" for other in SHARED}


@pytest.mark.parametrize("path", sorted(NODES.rglob("*.py")), ids=lambda path: path.name)
def test_no_node_needs_the_command_line(path):
    """`raised-hand play` needs nodes, so that the other way would be a circle."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    modules = [node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    assert not [module for module in modules if module.startswith("tracker.cli")]
