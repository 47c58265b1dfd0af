"""The robot's node `hand_detector` on ROS 2: a thin shell over `NodeCore`."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Callable
from typing import Any

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from nodes.ros.parameters import RosParameters
from nodes.ros.wiring import RosWiring
from tracker.config import NODE_NAME
from tracker.errors import ConfigError, TrackerError
from tracker.terminal.program import print_version

#: What makes names that are no parameters known.
FROM_OVERRIDES = {"automatically_declare_parameters_from_overrides": True}


class HandDetector(Node):
    """Who raises a hand, and where; see docs/ros.md for topics, services and parameters.

    It may live in a program of your own, beside other nodes; `destroy_node` ends it in order.

    Args:
        node_name: Its name, unless a remapping gives another one.
        options: As of every rclpy node: `namespace`, `context`, `parameter_overrides`, ...

    Raises:
        ConfigError: A parameter is unknown or out of range.
        ModelFileError: The hand models are not there.
    """

    def __init__(self, node_name: str = NODE_NAME, **options: Any) -> None:
        super().__init__(node_name, **options | FROM_OVERRIDES)
        self._wiring: RosWiring | None = None
        try:
            self._wiring = RosWiring(self, RosParameters(self))
        except TrackerError:
            super().destroy_node()
            raise
        self._wiring.listen()

    @property
    def is_alive(self) -> bool:
        """Whether the node still works; False after an error in the worker."""
        return self._wiring is None or self._wiring.core.is_alive

    def close(self) -> None:
        """Stop working, and publish that no hand is up; can be called again."""
        # Taken away first: a core that is stopped on purpose is no dead one.
        wiring, self._wiring = self._wiring, None
        if wiring is not None:
            wiring.close()

    def destroy_node(self) -> None:
        """Close, and take the node down."""
        self.close()
        super().destroy_node()


def main(args: list[str] | None = None) -> int:
    """Run the node until Ctrl-C.

    Returns:
        Exit status: 0, 1 if it failed, 2 if a parameter was off.
    """
    return run(HandDetector, args)


def run(make_node: Callable[[], HandDetector], args: list[str] | None = None) -> int:
    """Spin a node until SIGINT or SIGTERM, and end it in order.

    The executor has a thread of its own, and this one waits for signals, so that Ctrl-C is heard
    at once and the last messages can still be published.
    """
    print_version("--version" in (sys.argv if args is None else args))
    is_over = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: is_over.set())
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    try:
        return _spin(make_node, is_over)
    except TrackerError as error:
        print(error, file=sys.stderr)
        return 2 if isinstance(error, ConfigError) else 1
    finally:
        rclpy.try_shutdown()


def _spin(make_node: Callable[[], HandDetector], is_over: threading.Event) -> int:
    node = make_node()
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    spinning = threading.Thread(target=executor.spin, name="executor")
    spinning.start()
    while not is_over.wait(0.5) and node.is_alive and spinning.is_alive():
        pass
    if not is_over.is_set():
        node.get_logger().fatal("The worker thread stopped with an error, which is printed above.")
    executor.shutdown()
    spinning.join()
    node.destroy_node()
    return 0 if is_over.is_set() else 1


if __name__ == "__main__":
    sys.exit(main())
