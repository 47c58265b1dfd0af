"""Domains of our own on the loopback interface, and words to listen there."""

import fcntl
import itertools
import os
import random
import struct
import subprocess
import sys
import tempfile
import threading
import time
from collections import defaultdict
from pathlib import Path
from types import SimpleNamespace

import pytest

from nodes.shared.qos import PROFILES, Profile
from nodes.shared.topics import OUTPUT_TYPES, Output
from tracker.messages.types import build, deserialize, serialize

ROOT = Path(__file__).parents[3]
CLIENT = Profile(True, False, 10, "ROS 2's default for services.")


@pytest.fixture
def domain(monkeypatch):
    """A domain that no other test on this machine is in; for this process and its children."""
    # Above 101 the ports run into those that the system gives away.
    for number in random.SystemRandom().sample(range(1, 102), 101):
        claim = open(Path(tempfile.gettempdir()) / f"raised-hand-domain-{number}.lock", "w")
        try:
            fcntl.flock(claim, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            claim.close()
        else:
            break
    monkeypatch.setenv("ROS_DOMAIN_ID", str(number))
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    for name in ("CYCLONEDDS_URI", "ROS_LOCALHOST_ONLY", "ROS_STATIC_PEERS"):
        monkeypatch.delenv(name, raising=False)
    yield number
    claim.close()


@pytest.fixture
def make_node(domain):
    """Makes nodes in the test's own domain; they are closed afterwards."""
    from nodes.dds import Node

    nodes = []

    def make(name, **options):
        nodes.append(Node(name, **options))
        return nodes[-1]

    yield make
    for node in nodes:
        node.close()


@pytest.fixture
def until():
    """Lets nodes hand over what comes until something holds."""

    def wait(condition, *nodes, timeout_s=10.0):
        end = time.monotonic() + timeout_s
        while not condition():
            assert time.monotonic() < end, "it did not come to that"
            for node in nodes:
                node.spin_once(0.01)
            if not nodes:
                time.sleep(0.01)

    return wait


class Ear:
    """Hears everything a node says, in a thread, as bytes with their time of arrival."""

    def __init__(self, node):
        self.node = node
        self.heard = defaultdict(list)
        for output, type_name in OUTPUT_TYPES.items():
            name = output.value.replace("~", "/hand_detector")
            profile = PROFILES[output]._replace(depth=100)
            self.node.subscribe(name, type_name, self._hear(output), profile)
        self.thread = threading.Thread(target=node.spin)
        self.thread.start()

    def _hear(self, output):
        return lambda cdr: self.heard[output].append((time.monotonic(), cdr))

    def messages(self, output):
        return [deserialize(OUTPUT_TYPES[output], cdr) for _, cdr in list(self.heard[output])]

    def frames(self):
        """Stamp of every processed image, and whether a hand was up; both are reliable topics."""
        stamps = [stamp_of(message.header) for message in self.messages(Output.TRACKS)]
        raised = [message.data for message in self.messages(Output.HAND_RAISED)]
        return stamps, raised[-len(stamps) :]

    def poses(self):
        return {
            stamp_of(item.header): (item.pose.position.x, item.pose.position.y)
            for item in self.messages(Output.CUSTOMER_POSE)
        }

    def statuses(self):
        """The last diagnostics by name, with their values as a dictionary."""
        reports = self.messages(Output.DIAGNOSTICS)
        return {
            status.name.removeprefix("hand_detector: "): SimpleNamespace(
                level=int(status.level),
                message=status.message,
                values={item.key: item.value for item in status.values},
            )
            for report in reports[-1:]
            for status in report.status
        }

    def until(self, condition, timeout_s=30.0):
        end = time.monotonic() + timeout_s
        while not condition():
            assert time.monotonic() < end, "it did not happen"
            time.sleep(0.01)
        return time.monotonic()


def stamp_of(header):
    return header.stamp.sec * 10**9 + header.stamp.nanosec


@pytest.fixture
def ear(make_node):
    made = Ear(make_node("ear"))
    yield made
    made.node.stop()
    made.thread.join()


@pytest.fixture
def run(tmp_path, domain):
    """Starts a Python process in the test's domain; what is left over is killed in the end."""
    processes = []

    def start(*arguments, name):
        path = tmp_path / f"{name}.log"
        with path.open("wb") as log:
            process = subprocess.Popen(
                [sys.executable, *map(str, arguments)],
                stdout=log, stderr=subprocess.STDOUT, env=dict(os.environ), cwd=ROOT,
            )  # fmt: skip
        process.log = lambda: path.read_text(encoding="utf-8")
        processes.append(process)
        return process

    yield start
    for process in processes:
        if process.poll() is None:
            process.kill()
        process.wait()


@pytest.fixture
def start_node(run, ear, model_store):
    """Starts a node and waits until it says how it is doing."""

    def start(*arguments):
        process = run("-m", "nodes.dds_hand_detector", *arguments, name="node")
        ear.until(lambda: ear.heard[Output.DIAGNOSTICS] or process.poll() is not None, 60.0)
        assert process.poll() is None, process.log()
        return process

    return start


@pytest.fixture
def play(run, recording):
    """Plays the recording as drivers would."""

    def start(*arguments):
        return run(
            "-m", "tracker.cli", "play", recording, "--best-effort", "--delay", 2, *arguments,
            name="player",
        )  # fmt: skip

    return start


@pytest.fixture
def ask(make_node, ear, until):
    """Asks a service, spelled out byte by byte as rmw_cyclonedds has them."""
    numbers = itertools.count(1)

    def call(name, service, **request):
        client, replies = make_node("client"), []
        kinds = f"{service}_Request", f"{service}_Response"
        identity = f"clientid={next(numbers)};"
        writer = client._write(f"rq{name}Request", kinds[0], CLIENT, identity)
        reader = client._read(f"rr{name}Reply", kinds[1], CLIENT, identity)
        client._listen(reader, CLIENT, lambda cdr, _: replies.append(cdr))
        until(lambda: writer.get_publication_matched_status().current_count)
        until(lambda: reader.get_subscription_matched_status().current_count)
        body = serialize(build(kinds[0], **request)).cdr
        writer.write_cdr(body[:4] + struct.pack("<Qq", 1, 1) + body[4:])
        until(lambda: replies, client)
        return deserialize(kinds[1], replies[0][:4] + replies[0][20:])

    return call
