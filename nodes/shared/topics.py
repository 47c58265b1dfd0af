"""What goes in and what comes out: the one list of inputs, topics and services for both shells."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

from tracker.config import Config
from tracker.messages import types

#: diagnostic_msgs is only spoken by the nodes.
DIAGNOSTICS_TYPE = "diagnostic_msgs/msg/DiagnosticArray"


class Input(str, Enum):
    """What a node listens to; the values are the words of logs and diagnostics."""

    IMAGES = "images"
    SCAN = "scan"
    DEPTH = "depth"
    DEPTH_CAMERA_INFO = "depth_camera_info"
    TRANSFORMS = "transforms"
    STATIC_TRANSFORMS = "static transforms"
    CAMERA_INFO = "camera_info"
    MAP = "map"
    COMMANDS = "commands"


class Output(str, Enum):
    """What a node publishes; the values are its topics' names before remapping."""

    HAND_RAISED = "hand_raised"
    RAISED_HANDS = "~/raised_hands"
    CUSTOMER_POSE = "customer_pose"
    APPROACH_POSE = "~/approach_pose"
    WAITING_LIST = "~/waiting_list"
    ANSWERS = "~/answer"
    TRACKS = "~/tracks"
    MARKERS = "~/markers"
    GESTURE = "~/gesture"
    DEBUG_IMAGE = "hand_detection_debug"
    DIAGNOSTICS = "/diagnostics"


class InputTopic(NamedTuple):
    """A topic's name before remapping, and its type."""

    name: str
    type_name: str


#: By `image_transport`; image_transport's own way of naming the compressed topic.
IMAGE_TOPICS = {
    "raw": InputTopic("image_raw", types.IMAGE),
    "compressed": InputTopic("image_raw/compressed", types.COMPRESSED_IMAGE),
}

#: By `depth_transport`, likewise.
DEPTH_TOPICS = {
    "raw": InputTopic("depth", types.IMAGE),
    "compressed": InputTopic("depth/compressedDepth", types.COMPRESSED_IMAGE),
}

INPUT_TOPICS = {
    Input.SCAN: InputTopic("scan", types.LASER_SCAN),
    Input.CAMERA_INFO: InputTopic("camera_info", types.CAMERA_INFO),
    Input.MAP: InputTopic("map", types.OCCUPANCY_GRID),
    Input.DEPTH_CAMERA_INFO: InputTopic("depth_camera_info", types.CAMERA_INFO),
    Input.TRANSFORMS: InputTopic("/tf", types.TF_MESSAGE),
    Input.STATIC_TRANSFORMS: InputTopic("/tf_static", types.TF_MESSAGE),
    Input.COMMANDS: InputTopic("~/command", types.STRING),
}


def input_topics(config: Config) -> dict[Input, InputTopic]:
    """Every topic that a node listens to."""
    chosen = {Input.IMAGES: IMAGE_TOPICS[config.image_transport]}
    if config.depth_source == "scan":
        return chosen | {
            item: topic
            for item, topic in INPUT_TOPICS.items()
            if item is not Input.DEPTH_CAMERA_INFO
        }
    return chosen | {Input.DEPTH: DEPTH_TOPICS[config.depth_transport]} | INPUT_TOPICS


OUTPUT_TYPES = {
    Output.HAND_RAISED: types.BOOL,
    Output.RAISED_HANDS: types.DETECTIONS,
    Output.CUSTOMER_POSE: types.POSE_STAMPED,
    Output.APPROACH_POSE: types.POSE_STAMPED,
    Output.WAITING_LIST: types.DETECTIONS,
    Output.ANSWERS: types.STRING,
    Output.TRACKS: types.DETECTIONS,
    Output.MARKERS: types.MARKER_ARRAY,
    Output.GESTURE: types.STRING,
    Output.DEBUG_IMAGE: types.IMAGE,
    Output.DIAGNOSTICS: DIAGNOSTICS_TYPE,
}

#: Services before remapping, and their types.
RELEASE_SERVICE = ("~/release_customer", "std_srvs/srv/Trigger")
ENABLE_SERVICE = ("~/enable", "std_srvs/srv/SetBool")
RESET_SERVICE = ("~/reset", "std_srvs/srv/Trigger")
