"""examples/waiter.py against the node's core: messages over a wire, time by frames."""

import numpy as np
import pytest

from nodes.shared.topics import Input, Output
from tracker import Config, Hands, Scan
from tracker.messages import encode
from tracker.messages.types import STRING, build, serialize

START_NS = 1_000_000_000_000
PERIOD_NS = 100_000_000

#: Bearing in rad and range in m; who raises a hand from when to when, in s.
ANNA, BERT = (0.0, 2.0), (-0.35, 3.0)
CALLS = {ANNA: (0.0, 3.0), BERT: (1.0, 4.0)}


def hands_at(bearings_rad):
    landmarks = np.full((len(bearings_rad), 21, 2), 24.0)
    landmarks[:, :, 0] = 32.0 - 46.0 * np.tan(bearings_rad)[:, None]
    landmarks[:, 12, 1] -= 6.0
    one = np.ones(len(bearings_rad))
    return Hands(landmarks, one, one, one.astype(bool), one)


def scan_of(stamp_ns, people):
    angles = np.linspace(-np.pi, np.pi, 720)
    ranges = np.full(720, 6.0)
    for bearing_rad, range_m in people:
        ranges[np.abs(angles - bearing_rad) < 0.2 / range_m] = range_m
    return Scan(stamp_ns, "laser", -np.pi, 2 * np.pi / 719, 0.05, 12.0, ranges)


class Restaurant:
    """Customers who call, a node, and a waiter who drives."""

    def __init__(self, wire, waiter_class, drive_s, **options):
        self.wire, self.drive_s = wire, drive_s
        self.time_s, self.number = 0.0, 0
        self.ends_s = None
        self.drives, self.deaf_s = [], -1.0
        self.waiter = waiter_class(self._say, self._drive, service_s=2.0, **options)
        wire.detector.find = lambda image, hints: hands_at(
            [place[0] for place, (up, down) in CALLS.items() if up <= self.time_s < down]
        )

    def _say(self, command):
        if self.time_s < self.deaf_s:
            return  # lost on the way
        message = serialize(build(STRING, data=command))
        self.wire.core.receive(Input.COMMANDS, message)

    def _drive(self, pose, frame):
        assert frame == "map"
        self.drives.append((round(pose.position.x, 1), round(pose.position.y, 1)))
        self.ends_s = self.time_s + self.drive_s

    def run(self, until_s):
        wire = self.wire
        while self.time_s < until_s:
            stamp_ns = START_NS + self.number * PERIOD_NS
            wire.base(stamp_ns - 1_000_000)
            wire.base(stamp_ns + 1_000_000)
            wire.core.receive(Input.SCAN, encode(scan_of(stamp_ns, CALLS)))
            wire.image(stamp_ns)
            wire.settle()
            self.number += 1
            self.time_s = self.number / 10
            self.waiter.hear(wire.messages(Output.WAITING_LIST)[-1])
            wire.published[:] = [item for item in wire.published if item[0] is Output.ANSWERS]
            if self.ends_s is not None and self.time_s >= self.ends_s:
                self.ends_s = None
                self.waiter.arrived(True, self.time_s)
            self.waiter.think(self.time_s)

    @property
    def answers(self):
        return [message.data for message in self.wire.messages(Output.ANSWERS)]


@pytest.fixture
def restaurant(make_wire, waiter_class):
    def make(drive_s, **options):
        wire = make_wire(Config(background_after_s=0.0))
        wire.listened = set()
        wire.mounting()
        return Restaurant(wire, waiter_class, drive_s, **options)

    return make


@pytest.mark.parametrize("drive_s", [11.0, 18.0])
def test_everybody_who_called_is_served_once_in_order(restaurant, drive_s):
    made = restaurant(drive_s)
    made.run(2 * drive_s + 8.0)
    assert made.waiter.served == ["1", "2"]
    near_anna, near_bert = (1.2, 0.0), (2.1, -0.8)
    assert [np.linalg.norm(np.subtract(*pair)) < 0.4 for pair in
            zip(made.drives, [near_anna, near_bert], strict=True)] == [True, True]  # fmt: skip
    assert made.answers == [
        "serve 1: done: customer 1 is being served",
        "served 1: done: customer 1 is served",
        "serve 2: done: customer 2 is being served",
        "served 2: done: customer 2 is served",
    ]


def test_with_a_bar_each_customer_is_visited_twice_before_the_next(restaurant):
    bar = build(
        "geometry_msgs/msg/Pose",
        position=build("geometry_msgs/msg/Point", x=-3.0, y=1.0, z=0.0),
        orientation=build("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=0.0, w=1.0),
    )
    made = restaurant(3.0, bar=bar)
    made.run(36.0)
    assert made.waiter.served == ["1", "2"]
    assert [stop == (-3.0, 1.0) for stop in made.drives] == [False, True, False] * 2


def test_commands_that_are_lost_are_said_again(restaurant):
    made = restaurant(2.0)
    made.deaf_s = 4.0
    made.run(14.0)
    assert made.waiter.served == ["1", "2"]


def test_after_a_failed_drive_the_others_are_served_first(restaurant):
    made = restaurant(2.0)
    made.run(1.8)
    made.ends_s = None
    made.waiter.arrived(False, made.time_s)
    made.run(16.0)
    assert made.waiter.served == ["2", "1"]
