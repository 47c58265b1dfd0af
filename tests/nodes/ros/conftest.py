"""A node and a player in processes of their own, and an ear in this one.

Nothing here is used where rclpy cannot be imported; the tests are skipped then.
"""

import os
import signal
import subprocess
import sys
import threading
import time
from collections import defaultdict
from pathlib import Path
from types import SimpleNamespace

import pytest

from nodes.shared.qos import PROFILES
from nodes.shared.topics import OUTPUT_TYPES, Output
from tracker.messages.types import deserialize

ROOT = Path(__file__).parents[3]
HERE = Path(__file__).parent


def xy_of(pose_stamped):
    return pose_stamped.pose.position.x, pose_stamped.pose.position.y


def stamp_of(header):
    return header.stamp.sec * 10**9 + header.stamp.nanosec


class Ear:
    """Hears everything a node says, as bytes with their time of arrival."""

    def __init__(self):
        import rclpy
        from rclpy.executors import SingleThreadedExecutor

        from nodes.ros.wiring import _CLASSES, _qos

        rclpy.init()
        self.node = rclpy.create_node("ear")
        self.heard = defaultdict(list)
        for output, type_name in OUTPUT_TYPES.items():
            name = output.value.replace("~", "hand_detector")
            self.node.create_subscription(
                _CLASSES[type_name],
                name,
                lambda cdr, output=output: self.heard[output].append((time.monotonic(), cdr)),
                _qos(PROFILES[output]._replace(depth=100)),
                raw=True,
            )
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.thread = threading.Thread(target=self.executor.spin)
        self.thread.start()

    def close(self):
        import rclpy

        self.executor.shutdown()
        self.thread.join()
        self.node.destroy_node()
        rclpy.shutdown()

    def forget(self):
        self.heard.clear()

    def messages(self, output):
        return [deserialize(OUTPUT_TYPES[output], cdr) for _, cdr in list(self.heard[output])]

    def frames(self):
        """Stamp of every processed image, and whether a hand was up; both are reliable topics."""
        stamps = [stamp_of(message.header) for message in self.messages(Output.TRACKS)]
        raised = [message.data for message in self.messages(Output.HAND_RAISED)]
        return stamps, raised[-len(stamps) :]

    def poses(self):
        return {stamp_of(item.header): xy_of(item) for item in self.messages(Output.CUSTOMER_POSE)}

    def statuses(self):
        """The last diagnostics by name, as (level, message, values)."""
        reports = self.messages(Output.DIAGNOSTICS)
        if not reports:
            return {}
        return {
            status.name.removeprefix("hand_detector: "): SimpleNamespace(
                level=status.level,
                message=status.message,
                values={item.key: item.value for item in status.values},
            )
            for status in reports[-1].status
        }

    def until(self, condition, timeout_s=20.0):
        end = time.monotonic() + timeout_s
        while not condition():
            assert time.monotonic() < end, "it did not happen"
            time.sleep(0.01)
        return time.monotonic()

    def call(self, kind, name, request):
        client = self.node.create_client(kind, name)
        try:
            assert client.wait_for_service(30.0), f"no service {name}"
            future = client.call_async(request)
            self.until(future.done)
            return future.result()
        finally:
            self.node.destroy_client(client)


@pytest.fixture
def ear(monkeypatch):
    # A domain of its own, on this machine only.
    monkeypatch.setenv("ROS_DOMAIN_ID", str(110 + os.getpid() % 90))
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    made = Ear()
    yield made
    made.close()


@pytest.fixture
def run(tmp_path):
    """Starts a Python process; whatever is left over is killed in the end."""
    processes = []

    def start(*arguments, name):
        log = (tmp_path / f"{name}.log").open("wb")
        environment = os.environ | {
            "PYTHONPATH": f"{ROOT}{os.pathsep}{os.environ.get('PYTHONPATH', '')}"
        }
        process = subprocess.Popen(
            [sys.executable, *map(str, arguments)],
            stdout=log, stderr=subprocess.STDOUT, env=environment, cwd=tmp_path,
        )  # fmt: skip
        log.close()
        process.log = lambda: (tmp_path / f"{name}.log").read_text(encoding="utf-8")
        processes.append(process)
        return process

    yield start
    for process in processes:
        if process.poll() is None:
            process.kill()
        process.wait()
        print(process.log())  # pytest shows it where a test fails


@pytest.fixture
def start_node(run, ear, model_store):
    """Starts a node and waits until it says how it is doing."""

    def start(*ros_arguments, module="nodes.hand_detector"):
        process = run("-m", module, "--ros-args", *ros_arguments, name="node")
        ear.until(lambda: ear.heard[Output.DIAGNOSTICS] or process.poll() is not None, 60.0)
        assert process.poll() is None, process.log()
        return process

    return start


@pytest.fixture
def play(run, recording):
    """Plays the recording; `wait` for the end, or `terminate` before it."""

    def start(*arguments):
        return run(HERE / "play_recording.py", recording, *arguments, name="player")

    return start


@pytest.fixture
def interrupt():
    """Ctrl-C, and how it ended."""

    def press(process):
        began = time.monotonic()
        process.send_signal(signal.SIGINT)
        return process.wait(10.0), time.monotonic() - began

    return press
