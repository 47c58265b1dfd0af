import numpy as np
import pytest

from tracker.camera import CameraModel
from tracker.geometry import RigidTransform, euler_to_quaternion
from tracker.ranging import bearing_span_rad

CAMERA = CameraModel(400.0, 400.0, 330.0, 235.0)
SIZE = (640, 480)


def span_deg(roll_deg=0.0, pitch_deg=0.0, yaw_deg=0.0, camera=CAMERA):
    angles = np.radians([roll_deg, pitch_deg, yaw_deg])
    pose = RigidTransform(quaternion_xyzw=euler_to_quaternion(*angles))
    return np.degrees(bearing_span_rad(camera, SIZE, pose))


def test_a_level_camera_sees_what_its_columns_span():
    edges = np.degrees([-np.arctan2(640 - 330, 400), np.arctan2(330, 400)])
    assert span_deg(yaw_deg=75.0) == pytest.approx(edges)


def test_a_camera_on_its_right_side_sees_what_its_rows_span():
    # Its lower edge looks to the left.
    edges = np.degrees([-np.arctan2(235, 400), np.arctan2(480 - 235, 400)])
    assert span_deg(roll_deg=90.0) == pytest.approx(edges)


def test_an_upside_down_camera_swaps_left_and_right():
    right, left = span_deg()
    assert span_deg(roll_deg=180.0) == pytest.approx([-left, -right])


def test_a_camera_that_looks_down_sees_no_hands_where_it_sees_the_floor():
    right, left = span_deg(pitch_deg=25.0)
    level_right, level_left = span_deg()
    # Of its rays those near the horizon are in the upper part of the picture.
    assert left - right == pytest.approx(level_left - level_right, abs=4.0)


def test_a_camera_that_looks_straight_down_sees_all_around():
    right, left = span_deg(pitch_deg=90.0)
    assert left - right > 320.0


def test_a_fisheye_s_circle_within_the_picture_ends_the_view():
    lens = (-0.1, -0.02, 0.0, 0.0)  # r - 0.1 r^3 - 0.02 r^5 turns back at 80 degrees
    fisheye = CameraModel(180.0, 180.0, 320.0, 240.0, lens, "equidistant")
    end = np.degrees(np.sqrt((-0.3 + np.sqrt(0.09 + 0.4)) / 0.2))
    assert span_deg(camera=fisheye) == pytest.approx([-end, end], rel=0.01)
