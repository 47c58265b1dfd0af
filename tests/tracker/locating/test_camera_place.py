"""Where the camera is, and how it moves, at the time that a picture shows."""

import numpy as np
import pytest

from tracker import Config
from tracker.geometry import RigidTransform
from tracker.locating import CameraLocator, shown_ns
from tracker.transforms import StampedTransform, TransformBuffer

MS = 1_000_000


@pytest.fixture
def turning():
    """A camera that turns by 0.8 rad/s and drives by 0.5 m/s along y, known for one second."""
    buffer = TransformBuffer()
    for at_ms in range(0, 1001, 20):
        at_s = at_ms / 1000
        pose = RigidTransform.from_planar(0.0, 0.5 * at_s, 3.0 + 0.8 * at_s)
        buffer.add(StampedTransform(at_ms * MS, "map", "camera_link", pose))
    return buffer


@pytest.mark.parametrize("at_ms", [0, 500, 1000], ids=["first", "between", "last"])
def test_motion_comes_from_transforms_before_and_after(turning, at_ms):
    place = CameraLocator().locate(turning, at_ms * MS, "", Config())
    assert place.motion == pytest.approx([0.0, 0.5, 0.8], abs=1e-6)


def test_a_camera_with_a_static_transform_stands_still():
    buffer = TransformBuffer()
    buffer.add(StampedTransform(0, "map", "camera_link", RigidTransform(), is_static=True))
    assert CameraLocator().locate(buffer, 500 * MS, "", Config()).motion.tolist() == [0.0] * 3


def test_late_stamps_show_what_was_before():
    assert shown_ns(500 * MS, 0.05) == 450 * MS
    assert shown_ns(500 * MS, -0.05) == 550 * MS
    assert shown_ns(20 * MS, 0.05) == 0


def test_motion_goes_the_short_way_round(turning):
    angles = [
        CameraLocator().locate(turning, at_ms * MS, "", Config()).motion[2]
        for at_ms in range(100, 901, 20)
    ]
    assert angles == pytest.approx(np.full(len(angles), 0.8), abs=1e-6)
