"""A robot's drivers, for the tests: an .mcap's messages on ROS 2 at their pace.

    python play_recording.py RECORDING [--loop N] [--rate R] [--without TOPIC] [--late-tf S]

Images, scans and CameraInfo are offered best effort, as cameras and scanners do.
"""

import argparse
import importlib
import time
from collections import deque

import rclpy
from mcap.reader import make_reader
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

SENSORS = ("/image_raw", "/image_raw/compressed", "/scan", "/camera_info")
LATCHED = ("/tf_static", "/map")


def publisher_of(node, topic, type_name):
    package, _, name = type_name.split("/")
    reliability = ReliabilityPolicy.BEST_EFFORT if topic in SENSORS else ReliabilityPolicy.RELIABLE
    durability = DurabilityPolicy.VOLATILE
    if topic in LATCHED:
        durability = DurabilityPolicy.TRANSIENT_LOCAL
    qos = QoSProfile(depth=100, reliability=reliability, durability=durability)
    return node.create_publisher(
        getattr(importlib.import_module(f"{package}.msg"), name), topic, qos
    )


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("recording")
    parser.add_argument("--loop", type=int, default=1)
    parser.add_argument("--rate", type=float, default=1.0)
    parser.add_argument("--wait-for", default="/tf", help="begin when this topic has a listener")
    parser.add_argument("--without", action="append", default=[])
    parser.add_argument("--late-tf", type=float, default=0.0, help="seconds behind the others")
    arguments = parser.parse_args()
    rclpy.init()
    node = rclpy.create_node("player")
    with open(arguments.recording, "rb") as file:
        reader = make_reader(file)
        kinds = {
            channel.topic: reader.get_summary().schemas[channel.schema_id].name
            for channel in reader.get_summary().channels.values()
        }
        publishers = {
            topic: publisher_of(node, topic, kind)
            for topic, kind in kinds.items()
            if topic not in arguments.without and not topic.startswith("/truth")
        }
        hurry = time.monotonic() + 10.0  # wait for somebody to listen, but not for ever
        while (
            time.monotonic() < hurry
            and not publishers[arguments.wait_for].get_subscription_count()
        ):
            time.sleep(0.05)
        time.sleep(0.5)
        for _ in range(arguments.loop):
            began, first_ns = time.monotonic(), None
            held = deque()
            for _, channel, message in reader.iter_messages(topics=list(publishers)):
                first_ns = first_ns or message.log_time
                at_s = (message.log_time - first_ns) / 1e9
                while held and held[0][0] <= at_s:
                    publishers["/tf"].publish(held.popleft()[1])
                due = began + at_s / arguments.rate
                time.sleep(max(due - time.monotonic(), 0.0))
                if channel.topic == "/tf" and arguments.late_tf:
                    held.append((at_s + arguments.late_tf, message.data))
                else:
                    publishers[channel.topic].publish(message.data)
            for _, transform in held:
                publishers["/tf"].publish(transform)
    time.sleep(0.5)
    node.destroy_node()
    rclpy.shutdown()


main()
