"""A waiter: everybody who called is served once, in the order of the waiting list.

    ros2 run raised_hand_tracker hand_detector          # the node
    python3 examples/waiter.py                          # drives by Nav2's NavigateToPose
    python3 examples/waiter.py --pretend-drive-s 11     # without Nav2: every drive takes 11 s
    python3 examples/waiter.py --bar 1.0 -2.5 3.14      # order, bar, and back to the same customer

The class `Waiter` knows no ROS: it is told messages and time, and tells commands and drives.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from typing import Any

#: A command is said again after so long if the list does not show it: messages may be lost while
#: nodes find each other.
SAY_AGAIN_S = 1.0


class Waiter:
    """Serves one customer after the other.

    Args:
        say: Sends a command to the node, as "serve 3".
        drive: Starts a drive to a pose (geometry_msgs/Pose, in a frame); `arrived` is told of its
            end.
        service_s: How long a visit takes.
        bar: Where to drive between taking the order and bringing it; None serves in one visit.
    """

    def __init__(
        self,
        say: Callable[[str], None],
        drive: Callable[[Any, str], None],
        *,
        service_s: float = 3.0,
        bar: Any = None,
    ) -> None:
        self._say, self._drive = say, drive
        self._service_s, self._bar = service_s, bar
        self._customer: str | None = None
        self._list: Any = None
        self._wish, self._said_s = "", 0.0
        self._stops: list[str] = []
        self._busy_until_s: float | None = None
        self.served: list[str] = []

    def hear(self, waiting_list: Any) -> None:
        """Take in the message of ~/waiting_list (vision_msgs/Detection3DArray)."""
        self._list = waiting_list

    def think(self, now_s: float) -> None:
        """Decide what to do now; to be called a few times a second."""
        if self._list is None:
            return
        if self._wish and not self._is_so(self._wish):
            if now_s - self._said_s >= SAY_AGAIN_S:
                self._ask(self._wish, now_s)
            return
        self._wish = ""
        if self._customer is not None and not self._is_so(f"serve {self._customer}"):
            self._customer, self._stops, self._busy_until_s = None, [], None  # by somebody else
        if self._customer is None:
            self._choose(now_s)
        elif not self._stops:
            self._ask(f"served {self._customer}", now_s)
            self.served.append(self._customer)
            self._customer = None
        elif self._busy_until_s is None:
            self._busy_until_s = float("inf")
            self._go(self._stops[0])
        elif now_s >= self._busy_until_s:
            self._busy_until_s = None
            self._stops.pop(0)

    def arrived(self, is_there: bool, now_s: float) -> None:
        """A drive has ended: at its goal, or it failed."""
        if self._customer is None:
            return
        if is_there:
            self._busy_until_s = now_s + self._service_s
        else:
            self._ask(f"wait {self._customer}", now_s)  # the others first, then once more
            self._customer, self._stops, self._busy_until_s = None, [], None

    def _choose(self, now_s: float) -> None:
        for person in self._list.detections:
            if _state(person) == "waiting":
                self._customer = person.id
                self._stops = (
                    ["customer"] if self._bar is None else ["customer", "bar", "customer"]
                )
                self._ask(f"serve {person.id}", now_s)
                return

    def _go(self, stop: str) -> None:
        frame = self._list.header.frame_id
        pose = self._bar
        if stop == "customer":
            (person,) = (item for item in self._list.detections if item.id == self._customer)
            (pose,) = (
                result.pose.pose
                for result in person.results
                if result.hypothesis.class_id == "approach"
            )
        self._drive(pose, frame)

    def _ask(self, command: str, now_s: float) -> None:
        self._wish, self._said_s = command, now_s
        self._say(command)

    def _is_so(self, command: str) -> bool:
        """Whether the list shows what was asked for, or has lost that customer."""
        verb, number = command.split()
        expected = {"serve": "being_served", "served": "served", "wait": "waiting"}[verb]
        states = [_state(person) for person in self._list.detections if person.id == number]
        return states == [expected]


def _state(person: Any) -> str:
    return str(person.results[0].hypothesis.class_id)


def main() -> int:
    """Run a waiter until Ctrl-C."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--node", default="hand_detector", help="Name of the node.")
    parser.add_argument("--pretend-drive-s", type=float, help="Do not drive; wait for so long.")
    parser.add_argument("--service-s", type=float, default=3.0, help="How long a visit takes.")
    parser.add_argument(
        "--bar", type=float, nargs=3, metavar=("X", "Y", "YAW"), help="In the map."
    )
    parser.add_argument("--count", type=int, help="Stop after so many customers.")
    options, ros_arguments = parser.parse_known_args()
    return run(options, ros_arguments)


def run(options: argparse.Namespace, ros_arguments: list[str]) -> int:
    """Join ROS and serve."""
    import math
    import time

    import rclpy
    from geometry_msgs.msg import Pose, PoseStamped
    from rclpy.executors import ExternalShutdownException
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from std_msgs.msg import String
    from vision_msgs.msg import Detection3DArray

    rclpy.init(args=[sys.argv[0], *ros_arguments])
    node = rclpy.create_node("waiter")
    commands = node.create_publisher(String, f"{options.node}/command", 10)
    bar = None
    if options.bar is not None:
        bar = Pose()
        bar.position.x, bar.position.y, yaw = options.bar
        bar.orientation.z, bar.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)

    def say(command: str) -> None:
        node.get_logger().info(command)
        commands.publish(String(data=command))

    if options.pretend_drive_s is None:
        from nav2_msgs.action import NavigateToPose
        from rclpy.action import ActionClient

        navigator = ActionClient(node, NavigateToPose, "navigate_to_pose")
    else:
        navigator = None
    pretended_until_s: list[float] = []

    def drive(pose: Any, frame: str) -> None:
        node.get_logger().info(f"drives to {pose.position.x:.2f}, {pose.position.y:.2f}")
        if navigator is None:
            pretended_until_s.append(time.monotonic() + options.pretend_drive_s)
            return
        target = PoseStamped(pose=pose)
        target.header.frame_id = frame
        sent = navigator.send_goal_async(NavigateToPose.Goal(pose=target))
        sent.add_done_callback(on_sent)

    def on_sent(sent: Any) -> None:
        handle = sent.result()
        if not handle.accepted:
            waiter.arrived(False, time.monotonic())
            return
        succeeded = 4  # action_msgs/GoalStatus.STATUS_SUCCEEDED
        handle.get_result_async().add_done_callback(
            lambda ended: waiter.arrived(ended.result().status == succeeded, time.monotonic())
        )

    waiter = Waiter(say, drive, service_s=options.service_s, bar=bar)
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(
        Detection3DArray, f"{options.node}/waiting_list", waiter.hear, latched
    )

    def think() -> None:
        now_s = time.monotonic()
        if pretended_until_s and now_s >= pretended_until_s[0]:
            pretended_until_s.clear()
            waiter.arrived(True, now_s)
        waiter.think(now_s)

    node.create_timer(0.1, think)
    try:
        while options.count is None or len(waiter.served) < options.count or waiter._wish:
            rclpy.spin_once(node, timeout_sec=0.5)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.get_logger().info(f"served: {', '.join(waiter.served) or 'nobody'}")
    node.destroy_node()
    rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
