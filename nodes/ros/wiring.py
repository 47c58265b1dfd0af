"""Connects `NodeCore` with an rclpy node: topics, services and clock.

Both the plain and the lifecycle node use this. Subscriptions are raw: bytes go into the core and
come out of it, and no message is taken apart by rclpy.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid
from rclpy.clock import Clock, ClockType, JumpThreshold, TimeJump
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import CameraInfo, CompressedImage, Image, LaserScan
from std_msgs.msg import Bool, String
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage
from tf2_ros import Buffer
from vision_msgs.msg import Detection3DArray
from visualization_msgs.msg import MarkerArray

from nodes.ros.farewell import take_back
from nodes.ros.parameters import RosParameters
from nodes.ros.tf2_transforms import Tf2Transforms
from nodes.shared.core import NodeCore
from nodes.shared.diagnostics import REPORT_PERIOD_S
from nodes.shared.qos import PROFILES, Profile
from nodes.shared.topics import (
    ENABLE_SERVICE,
    OUTPUT_TYPES,
    RELEASE_SERVICE,
    RESET_SERVICE,
    Input,
    Output,
    input_topics,
)
from tracker.config import Config
from tracker.errors import TrackerError
from tracker.messages import Encoded
from tracker.tracking.machine_frame import begin_compiling

_CLASSES = {
    f"{package}/msg/{kind.__name__}": kind
    for package, kinds in {
        "sensor_msgs": (Image, CompressedImage, LaserScan, CameraInfo),
        "nav_msgs": (OccupancyGrid,),
        "tf2_msgs": (TFMessage,),
        "std_msgs": (Bool, String),
        "geometry_msgs": (PoseStamped,),
        "vision_msgs": (Detection3DArray,),
        "visualization_msgs": (MarkerArray,),
        "diagnostic_msgs": (DiagnosticArray,),
    }.items()
    for kind in kinds
}


class RosWiring:
    """A core with its publishers and services; `listen` adds the subscriptions.

    Args:
        node: Carries everything.
        parameters: The node's.

    Raises:
        ModelFileError: The hand models are not there.
    """

    def __init__(self, node: Node, parameters: RosParameters) -> None:
        self._node, self._parameters = node, parameters
        self._domain_id = node.context.get_domain_id()
        config = parameters.config
        self._topics = {
            item: (node.resolve_topic_name(name), _CLASSES[kind])
            for item, (name, kind) in input_topics(config).items()
        }
        self._buffer = Buffer(node=node)
        try:
            self.core = self._make_core(config)
        except TrackerError:
            self._take_buffer_down()
            raise
        self._publishers = {
            output: node.create_publisher(_CLASSES[kind], output.value, _qos(PROFILES[output]))
            for output, kind in OUTPUT_TYPES.items()
        }
        self._subscriptions: list[Any] = []
        self._services = [
            node.create_service(Trigger, RELEASE_SERVICE[0], self._on_release),
            node.create_service(SetBool, ENABLE_SERVICE[0], self._on_enable),
            node.create_service(Trigger, RESET_SERVICE[0], self._on_reset),
        ]
        backwards = JumpThreshold(
            min_forward=None, min_backward=Duration(seconds=-1), on_clock_change=True
        )
        self._jump_handle = node.get_clock().create_jump_callback(
            backwards, post_callback=self._on_jump
        )
        # On a steady clock: that /clock is silent is one of the things to be told.
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = node.create_timer(REPORT_PERIOD_S, self.core.diagnose, clock=steady)
        parameters.hand_on(self.core.configure)
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
        """End the core, take back a raised hand, and take down all that was made here."""
        self.stop_listening()
        self._parameters.hand_on(None)
        self._node.destroy_timer(self._timer)
        self._jump_handle.unregister()
        for service in self._services:
            self._node.destroy_service(service)
        self._take_buffer_down()
        is_up = self.core.is_hand_up
        self.core.stop()
        if is_up and not self._node.context.ok():
            take_back(self._publishers[Output.HAND_RAISED], self._domain_id)
        for publisher in self._publishers.values():
            self._node.destroy_publisher(publisher)

    def _make_core(self, config: Config) -> NodeCore:
        log = self._node.get_logger()
        begin_compiling(log.info, log.warning)
        return NodeCore(
            config,
            publish=self._publish,
            has_subscribers=self._has_subscribers,
            log=self._log,
            now_ns=lambda: self._node.get_clock().now().nanoseconds,
            transforms=Tf2Transforms(self._buffer),
            topic_names={item: name for item, (name, _) in self._topics.items()},
            node_name=self._node.get_fully_qualified_name(),
        )

    def _take_buffer_down(self) -> None:
        # tf2 leaves its service and its callback with the node, which would keep everything alive.
        self._buffer.jump_handle.unregister()
        self._node.destroy_service(self._buffer.srv)

    def _publish(self, output: Output, message: Encoded) -> None:
        with self._unless_shut_down():
            self._publishers[output].publish(message.cdr)

    def _has_subscribers(self, output: Output) -> bool:
        with self._unless_shut_down():
            return self._publishers[output].get_subscription_count() > 0
        return False

    @contextmanager
    def _unless_shut_down(self) -> Iterator[None]:
        """After the context is shut down, as by Ctrl-C, nothing can be logged."""
        try:
            yield
        except RuntimeError:  # RCLError is one
            if self._node.context.ok():
                raise

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
