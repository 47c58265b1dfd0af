"""What the nodes are tested with: a core on a wire of its own, and a recording with its answer.

On the wire what is published is kept, and time stands still until told.
"""

import importlib.util
import threading
import time
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from mcap.reader import make_reader

from nodes.shared.core import NodeCore
from nodes.shared.topics import Input, Output
from tracker import CameraImage, Config, Hands, Scan
from tracker.containers import DepthImage
from tracker.geometry import RigidTransform
from tracker.messages import encode
from tracker.messages.types import deserialize
from tracker.replay import replay
from tracker.simulation import load_scene, write_simulation
from tracker.transforms import StampedTransform

ROOT = Path(__file__).parents[2]
START_NS = 1_000_000_000_000
FRAME_NS = 33_333_333


class OneRaisedHand:
    """A detector that always sees one raised hand ahead; it can be held up."""

    work = None

    def __init__(self):
        self.stamps_ns = []
        self.resets = 0
        self.may_run = threading.Event()
        self.may_run.set()

    def find(self, image, hints=None):
        self.may_run.wait(10.0)
        self.stamps_ns.append(image.stamp_ns)
        landmarks = np.full((1, 21, 2), (32.0, 24.0))  # straight ahead
        landmarks[:, 12, 1] -= 6.0
        one = np.ones(1)
        return Hands(landmarks, one, one, one.astype(bool), one)

    def reset(self):
        self.resets += 1

    def configure(self, config):
        pass


class Wire:
    """Everything a core says, and short words to speak to it."""

    def __init__(self, config, **more):
        self.published, self.logged = [], []
        self.listened = set(Output)
        self.now_ns = START_NS
        self.steady_ns = 0
        self.detector = OneRaisedHand()
        self.core = NodeCore(
            config.replace(camera_fx=46.0, camera_fy=46.0, camera_cx=32.0, camera_cy=24.0),
            publish=lambda output, message: self.published.append((output, message)),
            has_subscribers=lambda output: output in self.listened,
            log=lambda level, text: self.logged.append((level, text)),
            now_ns=lambda: self.now_ns,
            steady_ns=lambda: self.steady_ns,
            detector=self.detector,
            **more,
        )
        self.core.start()

    def image(self, stamp_ns, width=64):
        picture = np.zeros((48, width, 3), np.uint8)
        self.core.receive(Input.IMAGES, encode(CameraImage(stamp_ns, "camera_link", picture)))

    def scan(self, stamp_ns):
        angles = np.linspace(-np.pi, np.pi, 360)
        ranges = np.where(np.abs(angles) < 0.15, 2.0, 6.0)
        scan = Scan(stamp_ns, "laser", -np.pi, 2 * np.pi / 359, 0.05, 12.0, ranges)
        self.core.receive(Input.SCAN, encode(scan))

    def depth(self, stamp_ns):
        pixels = np.full((48, 64), 2000, np.uint16)
        self.core.receive(Input.DEPTH, encode(DepthImage.of(stamp_ns, "camera_link", pixels)))

    def mounting(self):
        for child in ("camera_link", "laser"):
            sample = StampedTransform(0, "base_link", child, RigidTransform(), is_static=True)
            self.core.receive(Input.STATIC_TRANSFORMS, encode(sample))

    def base(self, stamp_ns, x_m=0.0):
        sample = StampedTransform(stamp_ns, "map", "base_link", RigidTransform((x_m, 0.0, 0.0)))
        self.core.receive(Input.TRANSFORMS, encode(sample))

    def diagnose(self):
        """The statuses by name, as a reader of /diagnostics gets them."""
        self.core.diagnose()
        message = self.messages(Output.DIAGNOSTICS)[-1]
        return {
            status.name.removeprefix("hand_detector: "): SimpleNamespace(
                level=status.level,
                message=status.message,
                values={item.key: item.value for item in status.values},
            )
            for status in message.status
        }

    def messages(self, output):
        return [deserialize(*item) for kind, item in list(self.published) if kind is output]

    def until(self, condition, timeout_s=10.0):
        """Wait for the worker."""
        end = time.monotonic() + timeout_s
        while not condition():
            assert time.monotonic() < end, "the worker did not get there"
            time.sleep(0.002)

    def settle(self):
        """Wait until the worker has done with every image that waits for nothing any more."""
        self.until(lambda: self.core.images_waiting == 0)
        for _ in range(3):  # a barrier may fall between two images of one batch
            done = threading.Event()
            self.core._inbox.order(done.set)
            assert done.wait(10.0), "the worker did not get there"


@pytest.fixture
def make_wire():
    """Makes a started core; it is stopped afterwards."""
    wires = []

    def make(config=None, **more):
        wires.append(Wire(config or Config(), **more))
        return wires[-1]

    yield make
    for wire in wires:
        wire.detector.may_run.set()
        wire.core.stop()
        assert not wire.core.is_alive


@pytest.fixture
def wire(make_wire):
    """A started core whose camera and laser are mounted on a base."""
    made = make_wire()
    made.mounting()
    return made


@pytest.fixture(scope="session")
def recording(tmp_path_factory):
    """Twelve seconds with one guest who raises a hand, 30 images a second."""
    scene = load_scene("lonely").model_copy(update={"duration_s": 12.0})
    path = tmp_path_factory.mktemp("recording") / "lonely.mcap"
    write_simulation(scene, path, seed=1)
    return path


@pytest.fixture(scope="session")
def replayed(recording, tmp_path_factory, model_store):
    """What `replay` makes of the recording: raised or not, and where, by stamp."""

    @cache
    def run(config=None):
        out = tmp_path_factory.mktemp("replay")
        replay(recording, out, config or Config())
        raised, xy = {}, {}
        with (out / "output.mcap").open("rb") as file:
            for schema, channel, message in make_reader(file).iter_messages(
                topics=["/hand_raised", "/customer_pose"]
            ):
                said = deserialize(schema.name, message.data)
                if channel.topic == "/hand_raised":
                    raised[message.log_time] = said.data
                else:
                    xy[message.log_time] = said.pose.position.x, said.pose.position.y
        return SimpleNamespace(raised=raised, xy=xy)

    return run


@pytest.fixture(scope="session")
def waiter_class():
    """`Waiter` of examples/waiter.py, which knows no ROS."""
    spec = importlib.util.spec_from_file_location("waiter", ROOT / "examples/waiter.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.Waiter


class Guests:
    """Who is to be served in a scene, by the scene's own words."""

    #: A raise has been noticed after so long: two images and a margin.
    TO_NOTICE_S = 0.5

    def __init__(self, scene):
        self.people = scene.people

    def order(self, service_s):
        """Numbers of the people in the order of service, each of which takes so long.

        The first who called is served first. A raise before the end of that service belongs to
        the same call, a later one is a new call.
        """
        raises = sorted((span.from_s, one.id) for one in self.people for span in one.raises)
        served, free_s, over_s = [], 0.0, {}
        for at_s, number in raises:
            if at_s < over_s.get(number, 0.0):
                continue
            served.append(number)
            free_s = over_s[number] = max(free_s, at_s + self.TO_NOTICE_S) + service_s
        return served

    def known_as(self, customers, places):
        """The people behind the customers' numbers, by their places on the waiting list."""
        xy_m = np.array([(one.path[0].x_m, one.path[0].y_m) for one in self.people])
        found = []
        for customer in customers:
            away_m = np.linalg.norm(xy_m - places[customer], axis=1)
            assert away_m.min() < 0.6, f"#{customer} at {places[customer]} is nobody"
            found.append(self.people[int(away_m.argmin())].id)
        return found


@pytest.fixture(scope="session")
def guests_of():
    return Guests


@pytest.fixture(scope="session")
def scene_recording(tmp_path_factory):
    """A scene by its name, and its recording as `raised-hand demo` makes it."""

    @cache
    def record(name):
        scene = load_scene(name)
        path = tmp_path_factory.mktemp("scene") / f"{name}.mcap"
        write_simulation(scene, path, seed=1, jpeg_quality=92)
        return scene, path

    return record
