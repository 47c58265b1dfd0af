"""How late is /hand_raised, from the image's stamp, beside perception's own time?

    python benchmarks/latency.py [--seconds 20]

Plays a simulated guest at 30 images a second to `raised-hand-dds`, every stamp the moment of
sending, and listens to what comes back. Run it on an idle machine; other work shows in the tail.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
from rich.console import Console
from rich.table import Table

from nodes.dds import Node
from nodes.shared.qos import PROFILES
from nodes.shared.topics import OUTPUT_TYPES, Input, Output
from tracker.camera import CameraModel
from tracker.containers import CameraImage, Truth
from tracker.messages import encode
from tracker.messages.types import deserialize
from tracker.perception.models import ModelStore, ensure_models
from tracker.simulation import load_scene, simulate
from tracker.transforms import StampedTransform

DOMAIN = "61"
LOOPBACK = (
    '<CycloneDDS><Domain><General><Interfaces><NetworkInterface name="lo"/></Interfaces>'
    "</General></Domain></CycloneDDS>"
)


class Listener:
    """Hears the answers, and how the node says it is doing."""

    def __init__(self, node: Node) -> None:
        self.late_s: list[float] = []
        self.values: dict[str, str] = {}
        self._answered_ns = 0
        takers = {
            Output.HAND_RAISED: self._take_answer,
            Output.TRACKS: self._take_tracks,
            Output.DIAGNOSTICS: self._take_diagnostics,
        }
        for output, take in takers.items():
            name = output.value.replace("~", "/hand_detector")
            node.subscribe(name, OUTPUT_TYPES[output], take, PROFILES[output])

    def _take_answer(self, cdr: bytes) -> None:
        self._answered_ns = time.time_ns()

    def _take_tracks(self, cdr: bytes) -> None:
        stamp = deserialize(OUTPUT_TYPES[Output.TRACKS], cdr).header.stamp
        self.late_s.append((self._answered_ns - stamp.sec * 10**9 - stamp.nanosec) / 1e9)

    def _take_diagnostics(self, cdr: bytes) -> None:
        for status in deserialize(OUTPUT_TYPES[Output.DIAGNOSTICS], cdr).status:
            self.values.update({item.key: item.value for item in status.values})


def play(node: Node, events: list[tuple[int, object]], seconds: float) -> None:
    """Send the events in real time, over and over, stamped with the moment they are sent."""
    writers = {
        "image": node.publisher("/image_raw", "sensor_msgs/msg/Image", PROFILES[Input.IMAGES]),
        "scan": node.publisher("/scan", "sensor_msgs/msg/LaserScan", PROFILES[Input.SCAN]),
        "tf": node.publisher("/tf", "tf2_msgs/msg/TFMessage", PROFILES[Input.TRANSFORMS]),
        "static": node.publisher(
            "/tf_static", "tf2_msgs/msg/TFMessage", PROFILES[Input.STATIC_TRANSFORMS]
        ),
    }
    fixed = [
        event for _, event in events if isinstance(event, StampedTransform) and event.is_static
    ]
    writers["static"].publish(encode(fixed).cdr)
    moving = [(log_ns, event) for log_ns, event in events if event not in fixed]
    length_ns = moving[-1][0] - moving[0][0]
    begin = time.monotonic()
    for turn in range(10**6):
        for log_ns, event in moving:
            due = begin + (turn * length_ns + log_ns - moving[0][0]) / 1e9
            if due - begin > seconds:
                return
            while (left := due - time.monotonic()) > 0:
                node.spin_once(left)
            if isinstance(event, CameraImage):
                writers["image"].publish(encode(replace(event, stamp_ns=time.time_ns())).cdr)
            elif isinstance(event, StampedTransform):
                writers["tf"].publish(encode(replace(event, stamp_ns=time.time_ns())).cdr)
            else:
                writers["scan"].publish(encode(replace(event, stamp_ns=time.time_ns())).cdr)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=20.0)
    seconds = parser.parse_args().seconds
    ensure_models(ModelStore())
    os.environ.update(
        ROS_DOMAIN_ID=DOMAIN, ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST", CYCLONEDDS_URI=LOOPBACK
    )
    events = [
        (log_ns, event)
        for log_ns, event in simulate(load_scene("lonely"), seed=1)
        if not isinstance(event, (Truth, CameraModel))
    ]
    command = [sys.executable, "-m", "nodes.dds_hand_detector"]
    detector = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    try:
        with Node("latency") as node:
            listener = Listener(node)
            play(node, events, 5.0)  # discovery, and the models' first images
            listener.late_s.clear()
            play(node, events, seconds)
            late_ms = 1e3 * np.array(listener.late_s)
    finally:
        detector.terminate()
        detector.wait()
    table = Table("from the image's stamp", "median", "p99", title=f"{len(late_ms)} images")
    table.add_row(
        "/hand_raised heard in another process",
        f"{np.median(late_ms):.1f} ms",
        f"{np.percentile(late_ms, 99):.1f} ms",
    )
    for label, key in [("/hand_raised published", "latency_ms"), ("of that, work", "busy_ms")]:
        values = [listener.values.get(f"{key}_{share}", "-") for share in ("median", "p99")]
        table.add_row(label, *(f"{value} ms" for value in values))
    Console().print(table)


if __name__ == "__main__":
    main()
