"""Equations 1 to 12 of the specification by number, and the laws of rigid transforms."""

import math

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given
from scipy.spatial.transform import Rotation, Slerp

from tracker.geometry import (
    BODY_FROM_OPTICAL,
    RigidTransform,
    camera_angle,
    euler_to_quaternion,
    facing_yaw,
    interpolate,
    normalize_angle,
    polar_to_cartesian,
    rotation_matrix,
    scan_index,
)

angles = st.floats(-math.pi, math.pi)
meters = st.floats(-50.0, 50.0)


@st.composite
def rigid_transforms(draw):
    rotation = Rotation.from_euler("ZYX", [draw(angles), draw(angles), draw(angles)])
    return RigidTransform(
        (draw(meters), draw(meters), draw(meters)), tuple(map(float, rotation.as_quat()))
    )


def same_rotation(p, q):
    """Quaternions q and -q are the same rotation."""
    return abs(float(np.dot(p, q))) == pytest.approx(1.0, abs=1e-12)


def test_equation_1_camera_angle_is_zero_on_the_axis():
    assert camera_angle(320.0, 320.0, 460.0) == 0.0


def test_equation_1_camera_angle_is_45_degrees_one_focal_length_to_the_right():
    np.testing.assert_allclose(
        camera_angle([780.0, -140.0], 320.0, 460.0), [math.pi / 4, -math.pi / 4]
    )


def test_equation_1_camera_angle_does_not_depend_on_the_downscaling():
    # 265.58 px right of the axis at fx 460 is 30 degrees: 460 * tan(30 deg) = 265.5811
    assert camera_angle(320.0 + 265.5811238272279, 320.0, 460.0) == pytest.approx(math.pi / 6)
    assert camera_angle(160.0 + 132.7905619136139, 160.0, 230.0) == pytest.approx(math.pi / 6)


@pytest.mark.parametrize(
    ("range_m", "angle_rad", "x_m"),
    [(2.0, 0.0, 2.0), (2.0, math.pi / 3, 1.0), (2.0, math.pi / 2, 0.0), (3.0, math.pi, -3.0)],
)
def test_equation_2_x_is_the_range_along_the_axis(range_m, angle_rad, x_m):
    assert polar_to_cartesian(range_m, angle_rad)[0] == pytest.approx(x_m, abs=1e-12)


@pytest.mark.parametrize(
    ("range_m", "angle_rad", "y_m"),
    [(2.0, 0.0, 0.0), (2.0, math.pi / 6, 1.0), (2.0, -math.pi / 6, -1.0), (3.0, math.pi / 2, 3.0)],
)
def test_equation_3_y_is_the_range_across_the_axis(range_m, angle_rad, y_m):
    assert polar_to_cartesian(range_m, angle_rad)[1] == pytest.approx(y_m, abs=1e-12)


def test_equation_4_the_hand_lies_in_the_plane_of_the_sensor():
    points = polar_to_cartesian([1.0, 2.0, 3.0], [0.1, 0.2, 0.3])
    assert points.shape == (3, 2)  # x and y alone: z is 0 by construction
    assert RigidTransform.from_planar(*points[0], 0.1).translation_m[2] == 0.0


@pytest.mark.parametrize(
    ("x_m", "y_m", "yaw_rad"),
    [
        (1.0, 0.0, math.pi),
        (0.0, 1.0, 1.5 * math.pi),
        (1.0, 1.0, 1.25 * math.pi),
        (0.0, -2.0, 0.5 * math.pi),
        (-1.0, 0.0, 2 * math.pi),
    ],
)
def test_equation_5_the_customer_faces_the_origin(x_m, y_m, yaw_rad):
    assert facing_yaw(x_m, y_m) == pytest.approx(yaw_rad)


def test_equation_6_a_customer_straight_ahead_is_turned_half_a_turn_about_z():
    np.testing.assert_allclose(euler_to_quaternion(0.0, 0.0, math.pi), [0, 0, 1, 0], atol=1e-15)


def test_equation_6_a_customer_to_the_left_looks_to_the_right():
    turned = Rotation.from_quat(euler_to_quaternion(0.0, 0.0, 1.5 * math.pi)).apply([1.0, 0, 0])
    np.testing.assert_allclose(turned, [0.0, -1.0, 0.0], atol=1e-12)


# sin and cos of 15, 30 and 45 degrees, the halves of roll 30, pitch 60, yaw 90 degrees
S15, C15 = 0.25881904510252074, 0.9659258262890683
S30, C30 = 0.5, 0.8660254037844387
S45 = C45 = 0.7071067811865476
BY_HAND = euler_to_quaternion(math.radians(30), math.radians(60), math.radians(90))


def test_equation_7_the_quaternion_has_the_x_component_worked_out_by_hand():
    # S15 C30 C45 - C15 S30 S45 = 0.158494 - 0.341506
    assert BY_HAND[0] == pytest.approx(S15 * C30 * C45 - C15 * S30 * S45)
    assert BY_HAND[0] == pytest.approx(-0.183013, abs=1e-6)


def test_equation_8_the_quaternion_has_the_y_component_worked_out_by_hand():
    # C15 S30 C45 + S15 C30 S45 = 0.341506 + 0.158494
    assert BY_HAND[1] == pytest.approx(0.5, abs=1e-6)


def test_equation_9_the_quaternion_has_the_z_component_worked_out_by_hand():
    # C15 C30 S45 - S15 S30 C45 = 0.591506 - 0.091506
    assert BY_HAND[2] == pytest.approx(0.5, abs=1e-6)


def test_equation_10_the_quaternion_has_the_w_component_worked_out_by_hand():
    # C15 C30 C45 + S15 S30 S45 = 0.591506 + 0.091506
    assert BY_HAND[3] == pytest.approx(0.683013, abs=1e-6)


@given(angles, angles, angles)
def test_equations_7_to_10_agree_with_scipy(roll_rad, pitch_rad, yaw_rad):
    expected = Rotation.from_euler("ZYX", [yaw_rad, pitch_rad, roll_rad]).as_quat()
    assert same_rotation(euler_to_quaternion(roll_rad, pitch_rad, yaw_rad), expected)


@pytest.mark.parametrize(
    ("angle_rad", "index"),
    [(-math.pi, 0), (0.0, 360), (0.004, 360), (-0.004, 359), (0.0088, 361), (1.0, 474)],
)
def test_equation_11_the_scan_index_is_rounded_down(angle_rad, index):
    # half a degree is 0.0087266 rad; 1 rad is 57.2958 degrees, so (180 + 57.2958) / 0.5 = 474.59
    assert scan_index(angle_rad, -math.pi, math.radians(0.5)) == index


def test_equation_11_the_scan_index_before_the_first_beam_is_negative():
    assert scan_index(-1.001, -1.0, 0.01) == -1


def test_equation_11_the_scan_index_counts_along_a_clockwise_scanner():
    assert scan_index(-0.55, 0.0, -0.1) == 5


@pytest.mark.parametrize(
    ("angle_rad", "normalized_rad"),
    [
        (0.0, 0.0),
        (math.pi, -math.pi),
        (-math.pi, -math.pi),
        (1.5 * math.pi, -0.5 * math.pi),
        (-1.5 * math.pi, 0.5 * math.pi),
        (7.0, 7.0 - 2 * math.pi),
        (-20.0, -20.0 + 6 * math.pi),
    ],
)
def test_equation_12_angles_are_normalized(angle_rad, normalized_rad):
    assert normalize_angle(angle_rad) == pytest.approx(normalized_rad, abs=1e-12)


@given(st.floats(-1e4, 1e4))
def test_equation_12_a_normalized_angle_is_the_same_direction(angle_rad):
    normalized = float(normalize_angle(angle_rad))
    assert -math.pi - 1e-9 <= normalized <= math.pi + 1e-9
    assert math.cos(normalized) == pytest.approx(math.cos(angle_rad), abs=1e-9)
    assert math.sin(normalized) == pytest.approx(math.sin(angle_rad), abs=1e-9)


def test_optical_axes_become_body_axes():
    forward, right, down = [0, 0, 1], [1, 0, 0], [0, 1, 0]
    np.testing.assert_array_equal(BODY_FROM_OPTICAL @ forward, [1, 0, 0])
    np.testing.assert_array_equal(BODY_FROM_OPTICAL @ right, [0, -1, 0])
    np.testing.assert_array_equal(BODY_FROM_OPTICAL @ down, [0, 0, -1])


@given(angles, angles, angles)
def test_rotation_matrix_agrees_with_scipy(roll_rad, pitch_rad, yaw_rad):
    rotation = Rotation.from_euler("xyz", [roll_rad, pitch_rad, yaw_rad])
    np.testing.assert_allclose(
        rotation_matrix(rotation.as_quat()), rotation.as_matrix(), atol=1e-12
    )


@given(rigid_transforms(), st.tuples(meters, meters, meters))
def test_applying_a_transform_agrees_with_scipy(a_from_b, point):
    expected = Rotation.from_quat(a_from_b.quaternion_xyzw).apply(point) + a_from_b.translation_m
    np.testing.assert_allclose(a_from_b.apply(point), expected, atol=1e-9)


@given(rigid_transforms(), rigid_transforms(), st.tuples(meters, meters, meters))
def test_a_chain_applies_its_links_from_right_to_left(a_from_b, b_from_c, point):
    np.testing.assert_allclose(
        (a_from_b @ b_from_c).apply(point), a_from_b.apply(b_from_c.apply(point)), atol=1e-8
    )


@given(rigid_transforms(), rigid_transforms(), rigid_transforms())
def test_chaining_is_associative(a_from_b, b_from_c, c_from_d):
    left, right = (a_from_b @ b_from_c) @ c_from_d, a_from_b @ (b_from_c @ c_from_d)
    np.testing.assert_allclose(left.translation_m, right.translation_m, atol=1e-8)
    assert same_rotation(left.quaternion_xyzw, right.quaternion_xyzw)


@given(rigid_transforms())
def test_a_transform_and_its_inverse_cancel(a_from_b):
    for nothing in (a_from_b @ a_from_b.inverse(), a_from_b.inverse() @ a_from_b):
        np.testing.assert_allclose(nothing.translation_m, (0.0, 0.0, 0.0), atol=1e-8)
        assert same_rotation(nothing.quaternion_xyzw, (0.0, 0.0, 0.0, 1.0))


def test_applying_keeps_the_batch_shape_and_rotating_ignores_the_translation():
    a_from_b = RigidTransform.from_planar(10.0, 20.0, math.pi / 2)
    assert a_from_b.apply(np.zeros((4, 5, 3))).shape == (4, 5, 3)
    np.testing.assert_allclose(a_from_b.rotate([1.0, 0.0, 0.0]), [0.0, 1.0, 0.0], atol=1e-12)


@given(meters, meters, st.floats(-3.14, 3.14))
def test_a_planar_pose_comes_back(x_m, y_m, yaw_rad):
    np.testing.assert_allclose(
        RigidTransform.from_planar(x_m, y_m, yaw_rad).planar, [x_m, y_m, yaw_rad], atol=1e-9
    )


@given(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5), angles)
def test_the_yaw_of_a_tilted_body_is_the_heading_of_its_x_axis(yaw_rad, pitch_rad, roll_rad):
    rotation = Rotation.from_euler("ZYX", [yaw_rad, pitch_rad, roll_rad])
    tilted = RigidTransform((0.0, 0.0, 0.0), tuple(map(float, rotation.as_quat())))
    assert math.remainder(tilted.yaw_rad - yaw_rad, 2 * math.pi) == pytest.approx(0.0, abs=1e-9)


@given(rigid_transforms(), rigid_transforms(), st.floats(0.0, 1.0))
def test_interpolation_agrees_with_scipy_slerp(start, end, share):
    rotations = Rotation.from_quat([start.quaternion_xyzw, end.quaternion_xyzw])
    between = interpolate(start, end, share)
    np.testing.assert_allclose(
        between.translation_m,
        (1 - share) * np.array(start.translation_m) + share * np.array(end.translation_m),
        atol=1e-9,
    )
    if (rotations[0].inv() * rotations[1]).magnitude() < 3.1:  # at half a turn both ways are short
        expected = Slerp([0.0, 1.0], rotations)(share)
        error = expected.inv() * Rotation.from_quat(between.quaternion_xyzw)
        assert error.magnitude() < 1e-7


def test_interpolation_takes_the_short_way_when_the_quaternions_have_opposite_signs():
    start = RigidTransform.from_planar(0.0, 0.0, 0.0)
    x, y, z, w = RigidTransform.from_planar(0.0, 0.0, 0.2).quaternion_xyzw
    end = RigidTransform((0.0, 0.0, 0.0), (-x, -y, -z, -w))
    assert interpolate(start, end, 0.25).yaw_rad == pytest.approx(0.05)


@pytest.mark.parametrize("turn_rad", [0.0, 1e-9, 1e-7, 1e-5, 1e-3])
def test_interpolation_of_nearly_equal_rotations_stays_exact(turn_rad):
    start, end = (RigidTransform.from_planar(0.0, 0.0, yaw) for yaw in (1.0, 1.0 + turn_rad))
    assert interpolate(start, end, 0.5).yaw_rad == pytest.approx(1.0 + turn_rad / 2, abs=1e-12)
