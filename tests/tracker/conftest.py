"""What the tests of several rooms share."""

import numpy as np
import pytest

from tracker import CameraImage, Config, Hands, Scan
from tracker.evaluation.detection.episode import CallerScore, FalseRaise
from tracker.evaluation.detection.scenes import FACTORS, Conditions
from tracker.evaluation.detection.study import DetectionStudy, Episode, Minute
from tracker.geometry import RigidTransform
from tracker.recording import RecordingWriter
from tracker.transforms import StampedTransform

START_NS = 1_700_000_000_000_000_000
SECOND_NS = 1_000_000_000

#: Camera and laser at the map's origin.
AT_ORIGIN = tuple(
    StampedTransform(0, "map", frame, RigidTransform(), is_static=True)
    for frame in ("camera_link", "laser")
)


class HandAhead:
    """A detector that sees one raised hand in the middle of each image, thumb to the left."""

    work = None

    def find(self, image, hints=None):
        landmarks = np.full((1, 21, 2), (image.width / 2, 100.0))
        landmarks[:, 4, 0] -= 30.0
        landmarks[:, 9, 1] -= 30.0
        landmarks[:, 12, 1] -= 60.0
        one = np.ones(1)
        return Hands(landmarks, one, one, one.astype(bool), one)

    def reset(self):
        pass

    def configure(self, config):
        pass


@pytest.fixture
def hand_ahead():
    """A `HandAhead`, for recordings by `write_bag`."""
    return HandAhead()


@pytest.fixture
def person_ahead():
    """A scan of somebody 1.5 m ahead as a 0.4 m wide piece, at a stamp."""

    def scan(stamp_ns):
        angles = np.radians(np.arange(720) / 2 - 180)
        ranges = np.where(np.abs(1.5 * np.tan(np.clip(angles, -1, 1))) < 0.2, 1.5, 5.0)
        return Scan(stamp_ns, "laser", -np.pi, np.radians(0.5), 0.05, 12.0, ranges)

    return scan


@pytest.fixture
def write_bag(person_ahead):
    """Writes a robot that stands and looks at somebody, 10 images and scans a second.

    The links come before image `links_at`; the stamps of image `jump` are 5 s back.
    """

    def write(
        path,
        seconds=2.0,
        *,
        links=AT_ORIGIN,
        links_at=0,
        images=True,
        scan=person_ahead,
        jump=None,
    ):
        with RecordingWriter(path) as writer:
            for number in range(int(seconds * 10)):
                log_ns = START_NS + number * SECOND_NS // 10
                stamp_ns = log_ns - 5 * SECOND_NS if number == jump else log_ns
                if number == links_at and links:
                    writer.write("/tf_static", log_ns, links)
                if scan is not None:
                    writer.write("/scan", log_ns, scan(stamp_ns))
                if images:
                    picture = np.full((480, 640, 3), number % 200, np.uint8)
                    image = CameraImage(stamp_ns, "camera_link", picture)
                    writer.write("/image_raw", log_ns, image)
        return path

    return write


@pytest.fixture
def detection_study():
    """By hand: six of six hands found at 1 m, two of six at 3 m; three minutes of nobody."""
    episodes = []
    for number in range(12):
        distance_m = 1.0 if number < 6 else 3.0
        frames = (2, 3, 4, 5, 6, 7, 10, 20, None, None, None, None)[number]
        error = float("nan") if frames is None else 0.01 * (number + 1)
        conditions = Conditions(
            distance_m,
            FACTORS["light"][number % 5],
            FACTORS["blur"][number % 3],
            FACTORS["skin"][number % 5],
            FACTORS["sleeve"][number % 3],
            FACTORS["hand"][number % 2],
            FACTORS["company"][number % 2],
        )
        score = CallerScore(82.0 / distance_m, frames, error, int(number == 11))
        episodes.append(Episode(number, conditions, "low", "sits", score))
    people = (("talk", 1.5), ("phone", 2.5), ("rest", 4.5))
    false = (FalseRaise(3.0, "talk", 1.5), FalseRaise(9.5, "phone", 2.5))
    minutes = (Minute(0, people, false), Minute(1, people, ()), Minute(2, people, false[:1]))
    return DetectionStudy(5, (1.0, 3.0), Config(), tuple(episodes), minutes)
