"""examples/waiter.py in the rooms of the demo and the bistro, with drives of 11 and 18 s.

Time is that of the recording, and goes on after its end until everybody is served. Hands are
found once for each scene; the core that both nodes share does the rest in every test.
"""

import threading
import time
from dataclasses import replace

import numpy as np
import pytest
from mcap.reader import make_reader

from nodes.shared.core import NodeCore
from nodes.shared.topics import Input, Output
from tracker import Config
from tracker.messages import Encoded
from tracker.messages.types import STRING, build, deserialize, serialize
from tracker.perception import open_detector

pytestmark = [pytest.mark.slow, pytest.mark.model]

INPUTS = {
    "/image_raw/compressed": Input.IMAGES,
    "/scan": Input.SCAN,
    "/camera_info": Input.CAMERA_INFO,
    "/map": Input.MAP,
    "/tf": Input.TRANSFORMS,
    "/tf_static": Input.STATIC_TRANSFORMS,
}
#: Images are handed over so much later than the rest, so that none waits for its transform.
LATE_NS = 100_000_000
STEP_NS = 100_000_000
SERVICE_S = 4.0


class TapedDetector:
    """Looks for hands in each image once, and remembers."""

    def __init__(self):
        self._inner, self._tape = None, {}

    def find(self, image, hints):
        if image.stamp_ns not in self._tape:
            hints = replace(hints, model_runs=None)  # as on a machine that keeps up
            self._tape[image.stamp_ns] = self._real.find(image, hints)
        return self._tape[image.stamp_ns]

    @property
    def _real(self):
        if self._inner is None:
            self._inner = open_detector(Config())
        return self._inner

    @property
    def work(self):
        return self._real.work

    def reset(self):
        pass

    def configure(self, config):
        pass


class Day:
    """A recording, the node, and a waiter whose drives take their time."""

    def __init__(self, path, detector, waiter_class, drive_s, **options):
        self.path, self.drive_s = path, drive_s
        self.now_ns = self.ends_ns = None
        self.answers, self.places, self.visits = [], {}, []
        self.core = NodeCore(
            Config(image_transport="compressed"),
            publish=self._hear,
            has_subscribers=lambda output: False,
            log=lambda level, text: None,
            now_ns=lambda: self.now_ns or 0,
            steady_ns=lambda: self.now_ns or 0,
            detector=detector,
        )
        self.waiter = waiter_class(self._say, self._drive, service_s=SERVICE_S, **options)
        self.core.start()

    def run(self):
        """Until the recording is over and nobody is served any more."""
        try:
            for log_ns, item, message in self._messages():
                self._pass_time(log_ns)
                self.core.receive(item, message)
                if item is Input.IMAGES:
                    self._settle()
            end_ns = self.now_ns + 600_000_000_000
            while self.now_ns < end_ns and (self.waiter._customer or self.waiter._wish):
                self._pass_time(self.now_ns + STEP_NS)
                self.core.diagnose()
                self._settle()
        finally:
            self.core.stop()
        return self

    def _messages(self):
        with self.path.open("rb") as file:
            kept = [
                (
                    message.log_time + (LATE_NS if "image" in channel.topic else 0),
                    INPUTS[channel.topic],
                    Encoded(schema.name, message.data),
                )
                for schema, channel, message in make_reader(file).iter_messages(topics=INPUTS)
            ]
        return sorted(kept, key=lambda item: item[0])

    def _pass_time(self, until_ns):
        """The waiter thinks ten times a second."""
        while self.now_ns is not None and self.now_ns + STEP_NS < until_ns:
            self.now_ns += STEP_NS
            self._think()
        self.now_ns = until_ns
        self._think()

    def _think(self):
        now_s = self.now_ns / 1e9
        if self.ends_ns is not None and self.now_ns >= self.ends_ns:
            self.ends_ns = None
            self.waiter.arrived(True, now_s)
        self.waiter.think(now_s)
        self._settle()

    def _settle(self):
        """Wait until the worker has nothing left to do."""
        for _ in range(2):  # once for images, once for orders that came meanwhile
            for _ in range(60_000):
                if not self.core.images_waiting:
                    break
                time.sleep(0.001)
            done = threading.Event()
            self.core._inbox.order(done.set)
            assert done.wait(60.0), "the worker did not get there"

    def _say(self, command):
        self.core.receive(Input.COMMANDS, serialize(build(STRING, data=command)))

    def _drive(self, pose, frame):
        self.visits.append((pose.position.x, pose.position.y))
        self.ends_ns = self.now_ns + round(self.drive_s * 1e9)

    def _hear(self, output, message):
        if output is Output.WAITING_LIST:
            said = deserialize(*message)
            for person in said.detections:
                position = person.results[0].pose.pose.position
                self.places[person.id] = position.x, position.y
            self.waiter.hear(said)
        elif output is Output.ANSWERS:
            self.answers.append(deserialize(*message).data)


@pytest.fixture(scope="module", params=["restaurant", "bistro"])
def room(request, guests_of, scene_recording):
    """A scene's guests, its recording, and the detector that has seen it."""
    scene, path = scene_recording(request.param)
    return guests_of(scene), path, TapedDetector()


@pytest.mark.parametrize("drive_s", [11.0, 18.0])
def test_everybody_who_called_is_served_once_in_order(room, waiter_class, drive_s):
    guests, path, detector = room
    day = Day(path, detector, waiter_class, drive_s).run()
    assert guests.known_as(day.waiter.served, day.places) == guests.order(drive_s + SERVICE_S)
    done = [f"{verb} {number}" for number in day.waiter.served for verb in ("serve", "served")]
    assert [answer.partition(":")[0] for answer in day.answers] == done
    assert all(": done: " in answer for answer in day.answers)


def test_in_two_visits_the_bar_lies_between_and_the_customer_is_the_same(room, waiter_class):
    guests, path, detector = room
    bar = build(
        "geometry_msgs/msg/Pose",
        position=build("geometry_msgs/msg/Point", x=-1.0, y=1.0, z=0.0),
        orientation=build("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=0.0, w=1.0),
    )
    day = Day(path, detector, waiter_class, 11.0, bar=bar).run()
    order = guests.order(3 * (11.0 + SERVICE_S))
    assert guests.known_as(day.waiter.served, day.places) == order
    visit, at_bar, delivery = day.visits[::3], day.visits[1::3], day.visits[2::3]
    assert set(at_bar) == {(-1.0, 1.0)}
    assert np.abs(np.subtract(visit, delivery)).max() < 0.4
