"""The transform buffer: chains, interpolation, bounded memory, and what it refuses."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from tracker.errors import ClockError, TransformError
from tracker.geometry import RigidTransform
from tracker.transforms import StampedTransform, TransformBuffer

SECOND = 1_000_000_000


def moving(stamp_s, x_m, yaw_rad=0.0, parent="map", child="base"):
    transform = RigidTransform.from_planar(x_m, 0.0, yaw_rad)
    return StampedTransform(round(stamp_s * SECOND), parent, child, transform)


def static(parent, child, transform):
    return StampedTransform(0, parent, child, transform, is_static=True)


def buffer_with(*samples, memory_s=10.0):
    buffer = TransformBuffer(memory_s)
    for sample in samples:
        buffer.add(sample)
    return buffer


def test_a_stamp_between_two_samples_is_interpolated_like_scipys_slerp():
    turns = Rotation.from_euler("xyz", [[0.1, -0.2, 0.3], [1.0, 0.5, -2.0]])
    starts = [(0.0, 1.0, 2.0), (4.0, -1.0, 0.0)]
    buffer = TransformBuffer()
    for number, (place, turn) in enumerate(zip(starts, turns, strict=True)):
        transform = RigidTransform(place, tuple(map(float, turn.as_quat())))
        buffer.add(StampedTransform(number * SECOND, "map", "base", transform))
    found = buffer.lookup("map", "base", SECOND // 4)
    np.testing.assert_allclose(found.translation_m, (1.0, 0.5, 1.5))
    np.testing.assert_allclose(found.matrix, Slerp([0, 1], turns)(0.25).as_matrix(), atol=1e-12)


def test_a_sample_at_the_very_stamp_is_returned_as_it_came():
    buffer = buffer_with(moving(1.0, 1.0), moving(2.0, 5.0), moving(3.0, 7.0))
    for stamp_s, x_m in ((1, 1.0), (2, 5.0), (3, 7.0)):
        found = buffer.lookup("map", "base", stamp_s * SECOND)
        assert found.translation_m == (x_m, 0.0, 0.0)


def test_a_chain_of_moving_and_static_links_is_looked_up_both_ways():
    camera_on_base = RigidTransform.from_planar(0.2, 0.1, math.pi / 2, z_m=1.2)
    buffer = buffer_with(
        moving(1.0, 1.0, parent="map", child="odom"),
        moving(2.0, 3.0, parent="map", child="odom"),
        moving(1.0, 0.0, math.pi / 2, parent="odom", child="base"),
        moving(2.0, 0.0, math.pi / 2, parent="odom", child="base"),
        static("base", "camera", camera_on_base),
    )
    # map from odom: (2, 0). odom from base: a quarter turn left, (0.2, 0.1) becomes (-0.1, 0.2).
    down = buffer.lookup("map", "camera", 3 * SECOND // 2)
    np.testing.assert_allclose(down.translation_m, (1.9, 0.2, 1.2))
    np.testing.assert_allclose(down.apply([1.0, 0.0, 0.0]), (0.9, 0.2, 1.2), atol=1e-12)
    up = buffer.lookup("camera", "map", 3 * SECOND // 2)
    np.testing.assert_allclose(up.apply(down.apply([1.0, 2.0, 3.0])), (1.0, 2.0, 3.0))


def test_two_branches_meet_at_their_common_frame_alone():
    buffer = buffer_with(
        static("base", "camera", RigidTransform.from_planar(0.3, 0.0, 0.0)),
        static("base", "laser", RigidTransform.from_planar(-0.1, 0.0, math.pi)),
        moving(1.0, 100.0),
    )
    found = buffer.lookup("laser", "camera", 50 * SECOND)  # map from base is not known then
    np.testing.assert_allclose(found.planar, (-0.4, 0.0, -math.pi), atol=1e-12)


def test_a_frame_seen_from_itself_is_the_identity():
    assert TransformBuffer().lookup("map", "map", 0) == RigidTransform()


def test_a_static_transform_holds_at_every_stamp():
    buffer = buffer_with(static("base", "laser", RigidTransform.from_planar(0.1, 0.0, 0.0)))
    for stamp_ns in (0, SECOND, 2**62):
        assert buffer.lookup("base", "laser", stamp_ns).translation_m[0] == pytest.approx(0.1)


@pytest.mark.parametrize("stamp_s", [0.999, 2.001])
def test_nothing_is_extrapolated(stamp_s):
    buffer = buffer_with(moving(1.0, 0.0), moving(2.0, 1.0))
    assert not buffer.can_lookup("map", "base", round(stamp_s * SECOND))
    with pytest.raises(TransformError, match=r"'base' to 'map'.*1\.000 s to 2\.000 s"):
        buffer.lookup("map", "base", round(stamp_s * SECOND))


def test_an_unknown_frame_is_named_with_those_heard_of():
    with pytest.raises(TransformError, match=r"'odm'; known frames: base, map"):
        buffer_with(moving(1.0, 0.0)).lookup("odm", "base", SECOND)


def test_an_empty_buffer_says_that_nothing_came():
    with pytest.raises(TransformError, match="known frames: none yet"):
        TransformBuffer().lookup("map", "base", 0)


def test_two_trees_that_do_not_touch_are_not_connected():
    buffer = buffer_with(moving(1.0, 0.0), moving(1.0, 0.0, parent="world", child="drone"))
    with pytest.raises(TransformError, match="'drone' and 'map' are not connected"):
        buffer.lookup("map", "drone", SECOND)


def test_a_circle_of_frames_is_refused_and_changes_nothing():
    buffer = buffer_with(
        moving(1.0, 1.0, parent="map", child="odom"),
        moving(1.0, 1.0, parent="odom", child="base"),
    )
    with pytest.raises(TransformError, match="loop of frames"):
        buffer.add(moving(1.0, 1.0, parent="base", child="map"))
    with pytest.raises(TransformError, match="loop of frames"):
        buffer.add(moving(1.0, 1.0, parent="map", child="map"))
    assert buffer.lookup("map", "base", SECOND).translation_m == (2.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("names", "transform"),
    [
        (("", "base"), RigidTransform()),
        (("map", ""), RigidTransform()),
        (("map", "base"), RigidTransform((math.nan, 0.0, 0.0))),
        (("map", "base"), RigidTransform((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0))),
        (("map", "base"), RigidTransform((0.0, 0.0, 0.0), (0.0, 0.0, math.inf, 1.0))),
    ],
    ids=["no parent", "no child", "NaN", "zero quaternion", "infinite quaternion"],
)
def test_an_unusable_transform_is_refused(names, transform):
    buffer = TransformBuffer()
    with pytest.raises(TransformError, match="unusable"):
        buffer.add(StampedTransform(SECOND, *names, transform))
    assert buffer.frames == set()


def test_a_negative_stamp_is_refused():
    with pytest.raises(ClockError, match="-1"):
        TransformBuffer().add(StampedTransform(-1, "map", "base", RigidTransform()))


def test_a_slightly_rounded_quaternion_is_normalized():
    rounded = RigidTransform((0.0, 0.0, 0.0), (0.0, 0.0, 0.707, 0.707))
    found = buffer_with(static("map", "base", rounded)).lookup("map", "base", 0)
    assert sum(value * value for value in found.quaternion_xyzw) == pytest.approx(1.0, abs=1e-15)


def test_samples_may_come_out_of_order():
    stamps = np.random.default_rng(3).permutation(50) * 0.1
    buffer = buffer_with(*(moving(stamp_s, 2.0 * stamp_s) for stamp_s in stamps))
    for stamp_s in (0.05, 1.23, 4.85):
        found = buffer.lookup("map", "base", round(stamp_s * SECOND))
        assert found.translation_m[0] == pytest.approx(2.0 * stamp_s)


def test_a_repeated_stamp_replaces_the_earlier_word():
    buffer = buffer_with(moving(1.0, 0.0), moving(2.0, 0.0), moving(2.0, 8.0))
    assert buffer.lookup("map", "base", 3 * SECOND // 2).translation_m[0] == pytest.approx(4.0)


def test_the_memory_is_bounded():
    buffer = TransformBuffer(memory_s=2.0)
    for number in range(10_000):
        buffer.add(moving(number * 0.01, 0.0))
    assert len(buffer._moving["base"]) == 201
    assert buffer.can_lookup("map", "base", 98 * SECOND)
    assert not buffer.can_lookup("map", "base", round(97.9 * SECOND))


def test_a_clock_that_jumped_back_starts_the_link_anew():
    buffer = buffer_with(moving(100.0, 0.0), moving(101.0, 0.0), moving(5.0, 7.0))
    assert buffer.lookup("map", "base", 5 * SECOND).translation_m[0] == 7.0
    assert not buffer.can_lookup("map", "base", 100 * SECOND)


def test_what_is_later_than_a_stamp_can_be_forgotten():
    buffer = buffer_with(moving(1.0, 1.0), moving(2.0, 2.0), moving(3.0, 3.0))
    buffer.forget_after(2 * SECOND)
    assert buffer.lookup("map", "base", 2 * SECOND).translation_m[0] == 2.0
    assert not buffer.can_lookup("map", "base", 5 * SECOND // 2)
    buffer.forget_after(0)
    with pytest.raises(TransformError, match="was not received since"):
        buffer.lookup("map", "base", SECOND)


def test_a_child_that_changes_its_parent_forgets_where_it_was():
    buffer = buffer_with(
        moving(1.0, 1.0, parent="map", child="base"),
        moving(2.0, 50.0, parent="odom", child="base"),
        static("map", "odom", RigidTransform()),
    )
    assert not buffer.can_lookup("map", "base", 3 * SECOND // 2)
    assert buffer.lookup("map", "base", 2 * SECOND).translation_m[0] == 50.0


def test_clearing_keeps_the_static_transforms():
    buffer = buffer_with(moving(1.0, 1.0), static("base", "laser", RigidTransform()))
    buffer.clear()
    assert buffer.frames == {"base", "laser"}


def test_leading_slashes_of_frame_names_do_not_matter():
    buffer = buffer_with(moving(1.0, 3.0, parent="/map", child="/base"))
    assert buffer.lookup("map", "/base", SECOND).translation_m[0] == 3.0
    assert buffer.lookup("/map", "map", SECOND) == RigidTransform()


def test_stamps_keep_their_nanoseconds_over_years():
    start_ns = 1_763_769_600_000_000_001  # as seconds in a float, 200 ns would be lost
    buffer = TransformBuffer()
    for offset_ns, x_m in ((0, 0.0), (4, 4.0)):
        transform = RigidTransform((x_m, 0.0, 0.0))
        buffer.add(StampedTransform(start_ns + offset_ns, "map", "base", transform))
    assert buffer.lookup("map", "base", start_ns + 1).translation_m[0] == pytest.approx(1.0)
