import numpy as np
import pytest

from tracker.camera import CameraModel
from tracker.containers import CameraImage, Scan, Truth
from tracker.geometry import RigidTransform
from tracker.messages import CameraInfo
from tracker.transforms import StampedTransform

START_NS = 1_700_000_000_000_000_000
STEP_NS = 100_000_000


@pytest.fixture
def sensor_items():
    """(topic, log_ns, item) of a short drive; noisy pictures, so that files have several chunks.

    The lasting transforms come last, as a recorder that joined late may have them.
    """

    def items(count=20, size=(120, 160)):
        rng = np.random.default_rng(8)
        for i in range(count):
            stamp_ns = START_NS + i * STEP_NS
            log_ns = stamp_ns + 5_000_000
            bgr = rng.integers(0, 256, (*size, 3), dtype=np.uint8)
            base = RigidTransform((0.1 * i, 0.0, 0.0))
            camera = CameraModel(100.0, 100.0, 80.0, 60.0)
            yield "/image_raw", log_ns, CameraImage(stamp_ns, "camera_link", bgr)
            info = CameraInfo(stamp_ns, "camera_link", size[1], size[0], camera)
            yield "/camera_info", log_ns, info
            ranges = rng.uniform(0.5, 5.0, 90).astype(np.float32)
            yield "/scan", log_ns + 1, Scan(stamp_ns, "laser", -1.5, 0.03, 0.1, 8.0, ranges)
            yield "/tf", log_ns + 2, StampedTransform(stamp_ns, "map", "base_link", base)
            yield "/truth/people", log_ns + 3, Truth(stamp_ns, [1], [[2.0, 0.0]], [1], [1])
        lasting = StampedTransform(START_NS, "base_link", "laser", RigidTransform((0.2, 0.0, 0.3)))
        yield "/tf_static", START_NS + count * STEP_NS, lasting

    return items
