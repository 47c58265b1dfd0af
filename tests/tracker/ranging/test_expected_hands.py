import numpy as np
import pytest

from tracker.camera import CameraModel
from tracker.geometry import RigidTransform, euler_to_quaternion
from tracker.ranging import expected_hands

CAMERA = CameraModel(460.0, 460.0, 320.0, 240.0)
AT_HEIGHT = RigidTransform((0.0, 0.0, 1.2))


def test_the_window_holds_a_raised_hand_at_any_distance():
    for distance in (1.0, 2.0, 5.0):
        (box,) = expected_hands(np.array([[distance, 0.5]]), CAMERA, AT_HEIGHT)
        # A hand 0.4 m to the right of the body, 1.5 to 1.7 m above the floor.
        column = 320 - 460 * (0.5 - 0.4) / distance
        rows = 240 - 460 * (np.array([1.5, 1.7]) - 1.2) / distance
        assert box[0] < column < box[2]
        assert np.all((box[1] < rows) & (rows < box[3]))


def test_a_window_is_as_large_as_its_person_is_near():
    boxes = expected_hands(np.array([[2.0, 0.0], [4.0, 0.0]]), CAMERA, AT_HEIGHT)
    near, far = boxes[:, 2:] - boxes[:, :2]
    np.testing.assert_allclose(near, 460 * 1.3 / 2.0)
    np.testing.assert_allclose(far, near / 2)


def test_people_behind_the_camera_have_no_window():
    assert len(expected_hands(np.array([[-2.0, 0.0], [0.1, 1.0]]), CAMERA, AT_HEIGHT)) == 0
    assert expected_hands(np.zeros((0, 2)), CAMERA, AT_HEIGHT).shape == (0, 4)


def test_windows_turn_with_the_camera():
    turned = RigidTransform((1.0, 2.0, 1.2), euler_to_quaternion(0.0, 0.0, np.pi / 2))
    (box,) = expected_hands(np.array([[1.0, 4.0]]), CAMERA, turned)
    (ahead,) = expected_hands(np.array([[2.0, 0.0]]), CAMERA, AT_HEIGHT)
    assert box == pytest.approx(ahead)


def test_a_camera_that_looks_up_sees_people_lower():
    up = RigidTransform((0.0, 0.0, 1.2), euler_to_quaternion(0.0, -np.radians(20.0), 0.0))
    (tilted,) = expected_hands(np.array([[3.0, 0.0]]), CAMERA, up)
    (level,) = expected_hands(np.array([[3.0, 0.0]]), CAMERA, AT_HEIGHT)
    assert tilted[1] > level[1] + 100


def test_a_fisheye_has_windows_for_people_beside_and_behind_it():
    fisheye = CameraModel(200.0, 200.0, 400.0, 300.0, (0.0,) * 4, "equidistant")
    people = np.array([[0.0, 2.0], [-0.7, -2.0]])
    windows = expected_hands(people, fisheye, AT_HEIGHT)
    hands = np.column_stack([people, [1.6, 1.6]]) - [0.0, 0.0, 1.2]
    for window, (column, row) in zip(windows, fisheye.pixels(hands), strict=True):
        assert window[0] < column < window[2]
        assert window[1] < row < window[3]


def test_nobody_beyond_the_lens_s_range_has_a_window():
    barrel = CameraModel(300.0, 300.0, 320.0, 240.0, (-0.5, 0.1, 0.0, 0.0), "plumb_bob")
    assert len(expected_hands(np.array([[1.0, 4.0], [2.0, 0.0]]), barrel, AT_HEIGHT)) == 1
