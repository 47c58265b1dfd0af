"""A program of somebody else's that has a hand detector in it, and shuts down before it closes."""

import sys

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.parameter import Parameter

from nodes.hand_detector import HandDetector


def main():
    """Spin in a namespace, with a parameter, under a name of its own, until Ctrl-C."""
    context = rclpy.Context()
    rclpy.init(context=context)
    node = HandDetector(
        node_name="waiter",
        namespace="robot1",
        context=context,
        parameter_overrides=[Parameter("processing_rate", value=7.0)],
        cli_args=["--ros-args", "-r", "image_raw:=/image_raw", "-r", "scan:=/scan"],
    )
    executor = rclpy.executors.SingleThreadedExecutor(context=context)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown(context=context)  # as rclpy's own handler of Ctrl-C does at once
        node.close()
        node.destroy_node()


if __name__ == "__main__":
    sys.exit(main())
