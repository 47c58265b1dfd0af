"""Pictures of rolled cameras are turned upright, and what was found in them back again."""

from itertools import pairwise

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.containers import CameraImage, Hands
from tracker.geometry import RigidTransform, euler_to_quaternion
from tracker.perception.upright import TOLERANCE_DEG, Turn, upright_turn

SIZE = (64, 48)
ROLLS = {"level": 0.0, "right side": 90.0, "left side": -90.0, "upside down": 180.0}


def camera(roll_deg, pitch_deg=0.0, yaw_deg=0.0):
    angles = np.radians([roll_deg, pitch_deg, yaw_deg])
    return RigidTransform((0.3, -0.2, 1.1), euler_to_quaternion(*angles))


def picture(seed=3):
    width, height = SIZE
    pixels = np.random.default_rng(seed).integers(0, 256, (height, width, 3), dtype=np.uint8)
    return CameraImage(5, "camera", pixels)


def hands_at(points_px, torso_px=(np.nan, np.nan)):
    one = np.ones(1)
    landmarks = np.array(points_px, float)[None]
    return Hands(landmarks, one, one, one.astype(bool), one, np.array([torso_px], float))


@pytest.mark.parametrize("roll_deg", ROLLS.values(), ids=list(ROLLS))
def test_a_camera_that_lies_on_a_side_has_its_pictures_turned_by_its_roll(roll_deg):
    turn = upright_turn(camera(roll_deg, pitch_deg=25.0, yaw_deg=-140.0))
    assert turn.clockwise_deg == pytest.approx(roll_deg)


@pytest.mark.parametrize(
    ("clockwise_deg", "quarters"), [(90.0, -1), (-90.0, 1), (180.0, 2)], ids=str
)
def test_a_quarter_turn_moves_every_pixel_unchanged(clockwise_deg, quarters):
    image = picture()
    turned = Turn(clockwise_deg).picture(image)
    np.testing.assert_array_equal(turned.bgr, np.rot90(image.bgr, quarters))
    assert (turned.stamp_ns, turned.frame_id) == (image.stamp_ns, image.frame_id)


def test_a_level_camera_s_picture_is_the_very_same():
    image, hands = picture(), hands_at(np.ones((21, 2)))
    assert Turn().picture(image) is image
    assert Turn().hands_back(hands, SIZE) is hands


def test_what_points_up_in_the_room_points_up_in_the_turned_picture():
    # A camera that lies on its right side sees the ceiling at the left edge.
    image = picture()
    image.bgr[:] = 0
    image.bgr[:, :20] = 255
    turned = upright_turn(camera(90.0)).picture(image)
    assert turned.bgr[:20].min() == 255
    assert turned.bgr[20:].max() == 0


@given(clockwise_deg=st.floats(-180.0, 180.0), seed=st.integers(0, 100))
def test_hands_come_back_to_the_pixels_they_were_turned_from(clockwise_deg, seed):
    turn = Turn(clockwise_deg)
    points_px = np.random.default_rng(seed).uniform(0, SIZE, (21, 2))
    dots = np.concatenate([points_px, points_px], axis=-1)  # boxes without an extent
    turned = turn.boxes(dots, SIZE)[:, :2]
    back = turn.hands_back(hands_at(turned, turned[4]), SIZE)
    np.testing.assert_allclose(back.landmarks_px[0], points_px, atol=1e-9)
    np.testing.assert_allclose(back.torso_px[0], points_px[4], atol=1e-9)
    assert np.isnan(turn.hands_back(hands_at(turned), SIZE).torso_px).all()


@pytest.mark.parametrize("clockwise_deg", [90.0, -90.0, 180.0, 30.0, -67.0, 135.0])
def test_a_dot_is_found_where_it_was_before_the_turn(clockwise_deg):
    image = picture()
    image.bgr[:] = 0
    cv2.circle(image.bgr, (50, 9), 2, (255, 255, 255), -1)
    turn = Turn(clockwise_deg)
    turned = turn.picture(image).bgr[..., 0].astype(float)
    rows, columns = np.indices(turned.shape)
    middle = [(turned * axis).sum() / turned.sum() for axis in (columns, rows)]
    back = turn.hands_back(hands_at(np.tile(middle, (21, 1))), SIZE)
    assert back.wrist_px[0] == pytest.approx([50.0, 9.0], abs=0.05)


def test_nothing_of_the_picture_is_cut_off():
    image = picture()
    image.bgr[:] = 255
    for clockwise_deg in (20.0, 45.0, -70.0, 150.0):
        turned = Turn(clockwise_deg).picture(image)
        assert turned.bgr[..., 0].sum() / 255 == pytest.approx(64 * 48, rel=0.02)


def test_boxes_of_a_quarter_turn_keep_their_extent_on_the_other_axis():
    boxes = Turn(90.0).boxes(np.array([[10.0, 4.0, 30.0, 8.0]]), SIZE)
    # Clockwise: x becomes y, and y from the top becomes x from the right.
    np.testing.assert_allclose(boxes, [[47.0 - 8.0, 10.0, 47.0 - 4.0, 30.0]])


@pytest.mark.parametrize("roll_deg", [TOLERANCE_DEG - 0.5, 0.5 - TOLERANCE_DEG])
def test_a_slight_lean_is_left_alone(roll_deg):
    assert upright_turn(camera(roll_deg)) == Turn()


def test_a_turn_that_wavers_at_the_limit_changes_once():
    turns = [Turn()]
    for number in range(40):
        roll_deg = TOLERANCE_DEG + 0.2 * (-1) ** number
        turns.append(upright_turn(camera(roll_deg), turns[-1]))
    assert sum(a != b for a, b in pairwise(turns)) == 1


def test_a_slow_roll_changes_the_turn_rarely_and_never_leaves_a_large_lean():
    turn, changes = Turn(), 0
    for roll_deg in np.arange(0.0, 360.0, 0.5):
        before, turn = turn, upright_turn(camera(roll_deg), turn)
        changes += turn != before
        lean_deg = (roll_deg - turn.clockwise_deg + 180.0) % 360.0 - 180.0
        assert abs(lean_deg) <= TOLERANCE_DEG
    assert changes <= 360.0 / TOLERANCE_DEG


def test_close_to_upside_down_is_upside_down_from_either_side():
    assert upright_turn(camera(175.0)) == upright_turn(camera(-175.0)) == Turn(180.0)


@pytest.mark.parametrize("pitch_deg", [90.0, -90.0, 84.0])
def test_a_camera_that_looks_straight_up_or_down_keeps_its_turn(pitch_deg):
    assert upright_turn(camera(0.0, pitch_deg)) == Turn()
    assert upright_turn(camera(120.0, pitch_deg), Turn(90.0)) == Turn(90.0)
