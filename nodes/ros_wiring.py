"""How does `NodeCore` hang on an rclpy node? Parameters, topics, services and clock.

Both the plain and the lifecycle node use this. Subscriptions are raw: bytes go into the core and
come out of it, and no message is taken apart by rclpy.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped
from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from rclpy.clock import Clock, ClockType, JumpThreshold, TimeJump
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import CameraInfo, CompressedImage, Image, LaserScan
from std_msgs.msg import Bool
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage
from tf2_ros import Buffer
from vision_msgs.msg import Detection3DArray
from visualization_msgs.msg import MarkerArray

from nodes.core import NodeCore
from nodes.diagnostics import REPORT_PERIOD_S
from nodes.parameters import Descriptor, changed, descriptors
from nodes.qos import PROFILES, Profile
from nodes.tf2_transforms import Tf2Transforms
from nodes.topics import (
    ENABLE_SERVICE,
    IMAGE_TOPICS,
    INPUT_TOPICS,
    OUTPUT_TYPES,
    RELEASE_SERVICE,
    RESET_SERVICE,
    Input,
)
from tracker.config import Config
from tracker.errors import ConfigError
from tracker.messages import Encoded
from tracker.parameter_file import is_ours

_CLASSES = {
    f"{package}/msg/{kind.__name__}": kind
    for package, kinds in {
        "sensor_msgs": (Image, CompressedImage, LaserScan, CameraInfo),
        "tf2_msgs": (TFMessage,),
        "std_msgs": (Bool,),
        "geometry_msgs": (PoseStamped,),
        "vision_msgs": (Detection3DArray,),
        "visualization_msgs": (MarkerArray,),
        "diagnostic_msgs": (DiagnosticArray,),
    }.items()
    for kind in kinds
}


def declare_parameters(node: Node) -> Config:
    """Declare every parameter of the configuration, with the values the user gave.

    Args:
        node: Made with `automatically_declare_parameters_from_overrides=True`, so that a name
            that is none is found rather than ignored.

    Raises:
        ConfigError: The user gave a parameter that is unknown or out of range.
    """
    given = {
        name: parameter.value
        for name, parameter in node.get_parameters_by_prefix("").items()
        if is_ours(name)
    }
    config = Config.from_mapping(given, origin="parameters")
    for name in given:
        node.undeclare_parameter(name)
    for item in descriptors():
        value = getattr(config, item.name)
        node.declare_parameter(item.name, value, _to_ros(item), ignore_override=True)
    return config


def current_parameters(node: Node) -> Config:
    """The declared parameters as they are now: anybody may have set them since.

    Raises:
        ConfigError: They do not go together.
    """
    names = Config.model_fields
    return Config.from_mapping({name: node.get_parameter(name).value for name in names})


class RosWiring:
    """A core with its publishers, services and parameters; `listen` adds the subscriptions.

    Args:
        node: Carries everything; its parameters are declared.
        config: From `declare_parameters`.

    Raises:
        ModelFileError: The hand models are not there.
    """

    def __init__(self, node: Node, config: Config) -> None:
        self._node = node
        self._publishers = {
            output: node.create_publisher(_CLASSES[kind], output.value, _qos(PROFILES[output]))
            for output, kind in OUTPUT_TYPES.items()
        }
        topics = {Input.IMAGES: IMAGE_TOPICS[config.image_transport]} | INPUT_TOPICS
        self._topics = {
            item: (node.resolve_topic_name(name), _CLASSES[kind])
            for item, (name, kind) in topics.items()
        }
        self._buffer = Buffer(node=node)
        self.core = NodeCore(
            config,
            publish=lambda output, message: self._publishers[output].publish(message.cdr),
            has_subscribers=lambda output: self._publishers[output].get_subscription_count() > 0,
            log=self._log,
            now_ns=lambda: node.get_clock().now().nanoseconds,
            transforms=Tf2Transforms(self._buffer),
            topic_names={item: name for item, (name, _) in self._topics.items()},
        )
        self._subscriptions: list[Any] = []
        self._services = [
            node.create_service(Trigger, RELEASE_SERVICE[0], self._on_release),
            node.create_service(SetBool, ENABLE_SERVICE[0], self._on_enable),
            node.create_service(Trigger, RESET_SERVICE[0], self._on_reset),
        ]
        node.add_pre_set_parameters_callback(_with_floats)
        node.add_on_set_parameters_callback(self._on_set)
        node.add_post_set_parameters_callback(self._after_set)
        backwards = JumpThreshold(
            min_forward=None, min_backward=Duration(seconds=-1), on_clock_change=True
        )
        self._jump_handle = node.get_clock().create_jump_callback(
            backwards, post_callback=self._on_jump
        )
        # On a steady clock: that /clock is silent is one of the things to be told.
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = node.create_timer(REPORT_PERIOD_S, self.core.diagnose, clock=steady)
        self.core.start()

    def listen(self) -> None:
        """Subscribe to everything."""
        self._subscriptions = [
            self._node.create_subscription(
                kind, name, self._receiver(item, kind), _qos(PROFILES[item]), raw=True
            )
            for item, (name, kind) in self._topics.items()
        ]

    def stop_listening(self) -> None:
        """Undo `listen`."""
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        self._subscriptions = []

    def close(self) -> None:
        """End the core, then take down what it published through."""
        self.stop_listening()
        self._node.destroy_timer(self._timer)
        self._jump_handle.unregister()
        self._node.remove_pre_set_parameters_callback(_with_floats)
        self._node.remove_on_set_parameters_callback(self._on_set)
        self._node.remove_post_set_parameters_callback(self._after_set)
        for service in self._services:
            self._node.destroy_service(service)
        self.core.stop()
        for publisher in self._publishers.values():
            self._node.destroy_publisher(publisher)

    def _receiver(self, item: Input, kind: Any) -> Callable[[bytes], None]:
        type_name = next(name for name, known in _CLASSES.items() if known is kind)
        return lambda cdr: self.core.receive(item, Encoded(type_name, cdr))

    def _on_release(self, _: Any, answer: Any) -> Any:
        answer.success, answer.message = self.core.release()
        return answer

    def _on_enable(self, request: Any, answer: Any) -> Any:
        answer.success, answer.message = True, self.core.enable(request.data)
        return answer

    def _on_reset(self, _: Any, answer: Any) -> Any:
        self.core.reset("as asked by ~/reset")
        answer.success, answer.message = True, "everybody is forgotten"
        return answer

    def _on_set(self, parameters: list[Parameter]) -> SetParametersResult:
        try:
            changed(self.core.config, _values(parameters))
        except ConfigError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _after_set(self, parameters: list[Parameter]) -> None:
        self.core.configure(changed(self.core.config, _values(parameters)))

    def _on_jump(self, jump: TimeJump) -> None:
        self.core.reset(f"the clock has jumped by {jump.delta.nanoseconds / 1e9:.3f} s")

    def _log(self, level: str, text: str) -> None:
        # rclpy wants one place of call for each level.
        logger = self._node.get_logger()
        if level == "error":
            logger.error(text)
        elif level == "warning":
            logger.warning(text)
        else:
            logger.info(text)


def _with_floats(parameters: list[Parameter]) -> list[Parameter]:
    """People write 8 for 8.0, and ROS would refuse it."""
    return [
        Parameter(item.name, Parameter.Type.DOUBLE, float(item.value))
        if item.type_ is Parameter.Type.INTEGER
        and item.name in Config.model_fields
        and Config.model_fields[item.name].annotation is float
        else item
        for item in parameters
    ]


def _values(parameters: list[Parameter]) -> dict[str, Any]:
    return {item.name: item.value for item in parameters}


def _to_ros(item: Descriptor) -> ParameterDescriptor:
    ros = ParameterDescriptor(
        description=item.description,
        additional_constraints=item.constraints,
        read_only=item.is_read_only,
    )
    if item.minimum is not None and item.maximum is not None:
        if isinstance(item.default, float):
            ros.floating_point_range = [
                FloatingPointRange(from_value=item.minimum, to_value=item.maximum)
            ]
        else:
            ros.integer_range = [
                IntegerRange(from_value=int(item.minimum), to_value=int(item.maximum), step=1)
            ]
    return ros


def _qos(profile: Profile) -> QoSProfile:
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=profile.depth,
        reliability=(
            ReliabilityPolicy.RELIABLE if profile.reliable else ReliabilityPolicy.BEST_EFFORT
        ),
        durability=(
            DurabilityPolicy.TRANSIENT_LOCAL
            if profile.transient_local
            else DurabilityPolicy.VOLATILE
        ),
    )
