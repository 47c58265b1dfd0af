"""Start the hand detector: `ros2 launch raised_hand_tracker hand_detector.launch.py --show-args`.

Imports nothing of the project, since `ros2 launch` may run in a Python that does not have its
dependencies.
"""

from pathlib import Path

import yaml
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import Parameter

PACKAGE, NODE_NAME = "raised_hand_tracker", "hand_detector"

#: Topic arguments, the names they replace, and what they carry.
TOPICS = {
    "image_topic": ("image_raw", "camera images (with image_transport:=compressed, too)"),
    "scan_topic": ("scan", "LiDAR scans"),
    "depth_topic": ("depth", "depth images (with depth_transport:=compressed, too)"),
    "depth_camera_info_topic": ("depth_camera_info", "a depth camera that is not registered"),
    "camera_info_topic": ("camera_info", "camera intrinsics"),
    "map_topic": ("map", "the map of the room"),
    "hand_raised_topic": ("hand_raised", "whether a hand is up"),
    "customer_pose_topic": ("customer_pose", "the selected customer"),
    "approach_pose_topic": ("~/approach_pose", "where to stand in front of that customer"),
    "debug_topic": ("hand_detection_debug", "the debug image"),
    "tf_topic": ("/tf", "transforms (`tf` for those of the namespace, as Nav2 has it)"),
    "tf_static_topic": ("/tf_static", "transforms that hold for ever"),
}


def generate_launch_description():
    """Arguments, and the node made of them."""
    share = Path(get_package_share_directory(PACKAGE))
    arguments = {
        "params_file": (str(share / "config/hand_detector.yaml"), "ROS parameter file"),
        "namespace": ("", "Namespace of the node and its topics"),
        "use_sim_time": ("false", "Take the time from /clock"),
        "image_transport": ("", "raw or compressed; empty: as the parameter file says"),
        "depth_transport": ("", "raw or compressed; empty: as the parameter file says"),
        "lifecycle": ("false", "Start the lifecycle node, unconfigured"),
        "respawn": ("false", "Start the node again when it ends"),
        "log_level": ("info", "debug, info, warn, error or fatal"),
        "rviz": ("false", "Show everything in RViz"),
        "rviz_config": (str(share / "config/hand_detector.rviz"), "RViz configuration"),
    } | {name: (default, f"Topic of {meaning}") for name, (default, meaning) in TOPICS.items()}
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=default, description=description)
                for name, (default, description) in arguments.items()
            ),
            OpaqueFunction(function=_hand_detector),
            Node(
                package="rviz2",
                executable="rviz2",
                arguments=["-d", LaunchConfiguration("rviz_config")],
                parameters=[
                    Parameter("use_sim_time", LaunchConfiguration("use_sim_time"), value_type=bool)
                ],
                condition=IfCondition(LaunchConfiguration("rviz")),
            ),
        ]
    )


def _hand_detector(context):
    def value_of(name):
        return LaunchConfiguration(name).perform(context)

    def is_true(name):
        return value_of(name).lower() in ("true", "1", "yes")

    # Each by itself: launch_ros writes a dictionary to a file that it leaves behind.
    own = [Parameter("use_sim_time", is_true("use_sim_time"), value_type=bool)]
    for transport in ("image_transport", "depth_transport"):
        if value_of(transport):
            own.append(Parameter(transport, value_of(transport), value_type=str))
    file, full_name = value_of("params_file"), f"{value_of('namespace').strip('/')}/{NODE_NAME}"
    remappings = [(default, value_of(name)) for name, (default, _) in TOPICS.items()]
    # The compressed topic hangs below the raw one, and has to be remapped on its own.
    remappings.append(("image_raw/compressed", value_of("image_topic") + "/compressed"))
    remappings.append(("depth/compressedDepth", value_of("depth_topic") + "/compressedDepth"))
    return [
        Node(
            package=PACKAGE,
            executable="lifecycle_hand_detector" if is_true("lifecycle") else "hand_detector",
            name=NODE_NAME,
            namespace=value_of("namespace"),
            parameters=[file, *_for_any_namespace(file, full_name.strip("/")), *own],
            remappings=[(old, new) for old, new in remappings if old != new],
            ros_arguments=["--log-level", value_of("log_level")],
            respawn=is_true("respawn"),
            output="screen",
        )
    ]


def _for_any_namespace(params_file, full_name):
    """What the file says of a node without a namespace, if this one has one.

    ROS takes `hand_detector:` in a file for `/hand_detector` alone, and would silently pass over
    the whole file once the node is in a namespace.
    """
    document = yaml.safe_load(Path(params_file).read_text(encoding="utf-8")) or {}
    sections = dict(_sections("", document))
    if not any(name.split("/")[-1] in (NODE_NAME, "*", "**") for name in sections):
        raise RuntimeError(
            f"{params_file} holds no parameters; needed is `{NODE_NAME}:` with `ros__parameters:`."
        )
    if full_name in sections or full_name == NODE_NAME:
        return []
    found = sections.get(NODE_NAME, {})
    return [Parameter(name, value, value_type=type(value)) for name, value in found.items()]


def _sections(name, tree):
    """Names of nodes without the first slash, each with its parameters."""
    for key, below in tree.items() if isinstance(tree, dict) else ():
        if key == "ros__parameters":
            yield name, below or {}
        else:
            yield from _sections(f"{name}/{key}".replace("//", "/").strip("/"), below)
