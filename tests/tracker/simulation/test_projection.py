import numpy as np
import pytest

from tracker.geometry import RigidTransform
from tracker.simulation.projection import Viewpoint, clip_to_front
from tracker.simulation.scene import Camera

LEVEL = Viewpoint.of(Camera(), RigidTransform.from_planar(0.0, 0.0, 0.0, 1.2))


def test_a_known_point_falls_on_a_known_pixel():
    # 2 m ahead, 0.5 m to the left, 1.7 m high: 460 * 0.5 / 2 = 115 px left and up of the middle.
    place = LEVEL.forward_left(np.array([2.0, 0.5]))
    np.testing.assert_allclose(LEVEL.pixels(place, 1.7), [205.0, 125.0])


def test_turning_left_moves_things_to_the_right():
    turned = Viewpoint.of(Camera(), RigidTransform.from_planar(1.0, 2.0, np.pi / 2, 1.2))
    place = turned.forward_left(np.array([1.5, 4.0]))  # 2 m ahead, 0.5 m to the right
    np.testing.assert_allclose(place, [2.0, -0.5])
    np.testing.assert_allclose(turned.pixels(place, 1.2), [435.0, 240.0])


def test_floor_and_walls_are_projected_like_their_points():
    view = Viewpoint.of(Camera(), RigidTransform.from_planar(0.3, -0.4, 0.5, 1.2))
    spot = np.array([2.5, 0.8])
    u, v, w = view.pixels_from_floor() @ [*spot, 1.0]
    np.testing.assert_allclose([u / w, v / w], view.pixels(view.forward_left(spot), 0.0))
    ends = np.array([[2.0, -1.0], [3.0, 1.5]])
    start, end = view.forward_left(ends)
    length = np.linalg.norm(ends[1] - ends[0])
    u, v, w = view.pixels_from_wall(start, end) @ [0.25 * length, 1.9, 1.0]
    spot = ends[0] + 0.25 * (ends[1] - ends[0])
    np.testing.assert_allclose([u / w, v / w], view.pixels(view.forward_left(spot), 1.9))


def test_what_lies_behind_the_camera_is_cut_off():
    square = np.array([[1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]])
    kept = clip_to_front(square, closed=True)
    assert len(kept) == 4
    assert kept[:, 0].min() == pytest.approx(0.08)
    wall = np.array([[-1.0, 0.0], [1.0, 2.0]])
    np.testing.assert_allclose(clip_to_front(wall, closed=False), [[0.08, 1.08], [1.0, 2.0]])
    assert len(clip_to_front(square - (5.0, 0.0), closed=True)) == 0
    assert len(clip_to_front(wall - (5.0, 0.0), closed=False)) == 0


@pytest.mark.parametrize(
    ("pixel", "inside"),
    [((0.0, 0.0), True), ((639.0, 479.0), True), ((639.5, 10.0), False), ((5.0, -0.1), False)],
)
def test_the_picture_ends_at_its_last_pixel(pixel, inside):
    assert LEVEL.is_in_picture(np.array([pixel])) is inside
