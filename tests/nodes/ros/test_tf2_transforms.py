import numpy as np
import pytest

pytest.importorskip("rclpy", reason="rclpy cannot be imported: no ROS 2 is sourced here")

from tf2_ros import Buffer

from nodes.ros.tf2_transforms import Tf2Transforms
from tracker.errors import TransformError
from tracker.geometry import RigidTransform, euler_to_quaternion
from tracker.transforms import StampedTransform, TransformBuffer

S = 1_000_000_000


def sample(stamp_s, parent, child, xyz=(0.0, 0.0, 0.0), yaw=0.0, is_static=False):
    transform = RigidTransform(xyz, euler_to_quaternion(0.0, 0.0, yaw))
    return StampedTransform(int(stamp_s * S), parent, child, transform, is_static)


@pytest.fixture
def both():
    """tf2's buffer and our own, with a robot that drives and turns."""
    buffers = Tf2Transforms(Buffer()), TransformBuffer()
    for buffer in buffers:
        buffer.add(sample(0, "base_link", "camera_link", (0.1, 0.0, 1.2), 0.3, is_static=True))
        for step in range(11):
            buffer.add(sample(100 + step / 10, "map", "/base_link", (step / 5, 1, 0), step / 7))
    return buffers


def test_both_buffers_interpolate_alike(both):
    for stamp_ns in np.random.default_rng(1).integers(100 * S, 101 * S, 50).tolist():
        tf2, own = (buffer.lookup("map", "camera_link", stamp_ns) for buffer in both)
        np.testing.assert_allclose(tf2.translation_m, own.translation_m, atol=1e-9)
        assert abs(np.dot(tf2.quaternion_xyzw, own.quaternion_xyzw)) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("target", "source", "stamp_s"),
    [("map", "camera_link", 99.9), ("map", "camera_link", 101.1), ("map", "nobody", 100.5)],
    ids=["too-early", "too-late", "unknown"],
)
def test_both_refuse_alike(both, target, source, stamp_s):
    for buffer in both:
        assert not buffer.can_lookup(target, source, int(stamp_s * S))
        with pytest.raises(TransformError):
            buffer.lookup(target, source, int(stamp_s * S))


def test_after_a_jump_back_earlier_transforms_are_taken_and_mountings_kept(both):
    for buffer in both:
        buffer.forget_after(50 * S)
        buffer.add(sample(50.0, "map", "base_link"))
        buffer.add(sample(50.2, "map", "base_link"))
        found = buffer.lookup("map", "camera_link", int(50.1 * S))
        assert found.translation_m == pytest.approx((0.1, 0.0, 1.2))


def test_transforms_that_tf2_would_ignore_are_refused_aloud(both):
    for buffer in both:
        for bad in (
            sample(100, "map", "map"),
            sample(100, "", "base_link"),
            sample(100, "map", "base_link", (np.nan, 0.0, 0.0)),
            StampedTransform(100 * S, "map", "base_link", RigidTransform((0, 0, 0), (0, 0, 0, 0))),
        ):
            with pytest.raises(TransformError):
                buffer.add(bad)
