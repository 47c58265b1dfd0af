"""A pipeline that sees one raised hand, and a dashboard that watches it."""

import numpy as np
import pytest

from tracker import CameraImage, Config, Hands, Pipeline
from tracker.containers import OccupancyGrid
from tracker.dashboard import Dashboard
from tracker.geometry import RigidTransform
from tracker.live.steering import PipelineSteering
from tracker.transforms import StampedTransform

START_NS, PERIOD_NS = 10**12, 100_000_000


class OneHand:
    work = None

    def find(self, image, hints=None):
        landmarks = np.full((1, 21, 2), (320.0, 240.0))
        landmarks[:, 12, 1] -= 60.0
        one = np.ones(1)
        return Hands(landmarks, one, one, one.astype(bool), one)

    def reset(self):
        pass

    def configure(self, config):
        pass


class Watched:
    """Frames on demand."""

    def __init__(self, can_steer=True):
        self.pipeline = Pipeline(Config(), OneHand())
        steering = PipelineSteering(self.pipeline) if can_steer else None
        self.dashboard = Dashboard(Config(), "test <camera>", steering)
        self.number = 0

    def mount(self):
        """The camera stands in the map, which has a wall 1.5 m to the right."""
        standing = RigidTransform((0.5, 0.0, 1.2))
        mounted = StampedTransform(0, "map", "camera_link", standing, is_static=True)
        self.pipeline.add_transform(mounted)
        cells = np.zeros((20, 20), np.int8)
        cells[0] = 100
        self.pipeline.set_map(OccupancyGrid(0, "map", 0.1, (0.0, -1.5, 0.0), cells))

    def run(self, frames):
        for _ in range(frames):
            stamp_ns = START_NS + self.number * PERIOD_NS
            image = CameraImage(stamp_ns, "", np.zeros((480, 640, 3), np.uint8))
            self.dashboard.watch(image, self.pipeline.process(image), 0.02)
            self.number += 1


@pytest.fixture
def make_watched():
    return Watched


@pytest.fixture
def watched():
    return Watched()
