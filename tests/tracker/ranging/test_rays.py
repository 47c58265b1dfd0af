from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tracker import Config, Hands
from tracker.camera import CameraModel
from tracker.geometry import RigidTransform, euler_to_quaternion
from tracker.ranging import body_pose, hand_rays

CAMERA = CameraModel(460.0, 460.0, 320.0, 240.0)


def hands_at(*wrists):
    landmarks = np.tile(np.array(wrists, float)[:, None, :], (1, 21, 1))
    one = np.ones(len(wrists))
    return Hands(landmarks, one, one, one.astype(bool), one)


def pixel_of(point_body, camera=CAMERA):
    x, y, z = point_body
    return camera.cx - camera.fx * y / x, camera.cy - camera.fy * z / x


def test_equation_1_is_the_level_camera_with_left_positive():
    rays = hand_rays(hands_at((540, 100)), CAMERA, RigidTransform(), Config())
    # arctan(220 / 460) = 25.5600 degrees to the right.
    assert np.degrees(rays.bearing_rad) == pytest.approx([-25.5600], abs=1e-3)


def test_equation_1_keeps_its_own_sign_by_parameter():
    config = Config(bearing_convention="spec")
    rays = hand_rays(hands_at((540, 100)), CAMERA, RigidTransform(), config)
    assert np.degrees(rays.bearing_rad) == pytest.approx([25.5600], abs=1e-3)


@pytest.mark.parametrize(("roll", "pitch"), [(0.0, -0.3), (0.2, 0.0), (-0.15, 0.25)])
def test_a_tilted_camera_gives_the_bearing_of_the_point_it_sees(roll, pitch):
    attitude = Rotation.from_euler("ZYX", [0.0, pitch, roll])
    point_level = np.array([3.0, 0.8, 0.5])
    pixel = pixel_of(attitude.inv().apply(point_level))
    pose = RigidTransform(quaternion_xyzw=tuple(attitude.as_quat()))
    rays = hand_rays(hands_at(pixel), CAMERA, pose, Config())
    heading = rays.bearing_rad + rays.origin[2]
    assert heading == pytest.approx([np.arctan2(0.8, 3.0)], abs=1e-9)


def test_the_camera_s_yaw_and_place_are_the_ray_s_origin():
    pose = RigidTransform((1.0, 2.0, 1.2), euler_to_quaternion(0.0, 0.0, 0.7))
    rays = hand_rays(hands_at((320, 50)), CAMERA, pose, Config())
    assert rays.origin == pytest.approx([1.0, 2.0, 0.7])
    assert rays.bearing_rad == pytest.approx([0.0], abs=1e-12)


def test_an_optical_frame_sees_what_its_body_frame_sees():
    # REP-103: optical z is forward, x right, y down.
    optical = Rotation.from_matrix([[0, 0, 1], [-1, 0, 0], [0, -1, 0]])
    looked_up = RigidTransform((0.1, 0.0, 1.2), tuple(optical.as_quat()))
    pose = body_pose(looked_up, "camera_color_optical_frame", "auto")
    assert pose.rotate([1.0, 0.0, 0.0]) == pytest.approx([1.0, 0.0, 0.0])
    assert pose.rotate([0.0, 1.0, 0.0]) == pytest.approx([0.0, 1.0, 0.0])
    assert body_pose(looked_up, "camera_link", "auto") is looked_up
    assert body_pose(looked_up, "camera_link", "optical") is not looked_up


def test_pixel_noise_becomes_bearing_noise_by_the_pinhole_s_derivative():
    # A hand without length: 0.3 px differ from image to image, 2 px stay.
    rays = hand_rays(hands_at((420, 240)), CAMERA, RigidTransform(), Config(wrist_std_px=2.0))
    step = hand_rays(hands_at((420 + np.hypot(0.3, 2.0), 240)), CAMERA, RigidTransform(), Config())
    assert rays.bearing_std_rad[0] == pytest.approx(
        abs(step.bearing_rad[0] - rays.bearing_rad[0]), rel=0.01
    )


@pytest.mark.parametrize(
    ("length_px", "noise_px"),
    [
        (16.0, np.hypot(0.38, 1.32)),  # five meters away: 0.16 degrees
        (83.0, np.hypot(0.715, 2.66)),  # one meter
    ],
)
def test_a_wrist_is_as_uncertain_as_its_hand_is_large(length_px, noise_px):
    hand = hands_at((320, 240))
    points = hand.landmarks_px.copy()
    points[0, 12, 1] -= length_px
    longer = Hands(points, hand.score, hand.right, hand.raised, hand.raise_measure)
    rays = hand_rays(longer, CAMERA, RigidTransform(), Config())
    assert rays.bearing_std_rad[0] * CAMERA.fx == pytest.approx(noise_px)


def test_where_a_torso_is_known_the_ray_goes_there():
    hands = replace(hands_at((540, 100), (540, 100)), torso_px=[(320, 200), (np.nan, np.nan)])
    rays = hand_rays(hands, CAMERA, RigidTransform(), Config())
    assert np.degrees(rays.bearing_rad) == pytest.approx([0.0, -25.5600], abs=1e-3)


def test_pixel_noise_at_the_edge_of_a_fisheye_is_as_in_its_middle():
    fisheye = CameraModel(200.0, 200.0, 320.0, 240.0, (0.0,) * 4, "equidistant")
    rays = hand_rays(hands_at((320, 240), (20, 240)), fisheye, RigidTransform(), Config())
    assert rays.bearing_rad == pytest.approx([0.0, 1.5])
    assert rays.bearing_std_rad[1] == pytest.approx(rays.bearing_std_rad[0], rel=1e-3)


def test_a_hand_beyond_the_lens_s_range_has_no_bearing():
    barrel = CameraModel(300.0, 300.0, 320.0, 240.0, (-0.5, 0.1, 0.0, 0.0), "plumb_bob")
    rays = hand_rays(hands_at((320, 240), (5, 240)), barrel, RigidTransform(), Config())
    assert np.isnan(rays.bearing_rad).tolist() == [False, True]
