import numpy as np
import pytest

from tracker.perception.gestures.shape import finger_stretch, hand_shape, palm_faces, thumb_rise
from tracker.simulation.hand_signs import draw_hands
from tracker.simulation.rendering.hand_shape import hand_landmarks


@pytest.fixture
def palm():
    """A right hand's palm as its opposite sees it, fingers up, 100 px long."""
    landmarks = hand_landmarks((0.0, 0.0), 0.0, thumb_right=True, length_m=100.0)
    return (landmarks * [1.0, -1.0])[None] + [300.0, 200.0]


def turned(landmarks, angle_rad):
    cos, sin = np.cos(angle_rad), np.sin(angle_rad)
    return landmarks @ np.array([[cos, sin], [-sin, cos]])


@pytest.mark.parametrize("name", ["palm", "fist", "thumb"])
def test_place_size_and_turn_do_not_change_a_shape(name):
    hands = draw_hands(name, 20, np.random.default_rng(1)).landmarks_px
    moved = 3.0 * turned(hands, 2.0) + [500.0, -80.0]
    np.testing.assert_allclose(hand_shape(moved), hand_shape(hands), atol=1e-9)


def test_the_other_hand_has_the_same_shape():
    hands = draw_hands("victory", 20, np.random.default_rng(2)).landmarks_px
    np.testing.assert_allclose(hand_shape(hands * [-1.0, 1.0]), hand_shape(hands), atol=1e-9)


def test_the_fingers_of_an_upright_shape_begin_above_the_wrist(palm):
    points = hand_shape(palm).reshape(20, 2)
    roots = points[[4, 8, 12, 16]].mean(axis=0)
    np.testing.assert_allclose(roots, [0.0, 1.0], atol=0.1)
    assert roots[0] == pytest.approx(0.0)


def test_a_collapsed_hand_has_a_finite_shape():
    assert np.isfinite(hand_shape(np.zeros((1, 21, 2)))).all()


def test_a_right_palm_faces_the_camera_and_turns_its_back_as_a_left_hand(palm):
    right, left = palm_faces(palm, np.ones(1)), palm_faces(palm, np.zeros(1))
    assert right[0] == pytest.approx(-left[0])
    assert right[0] > 0.4


def test_a_palm_faces_the_camera_however_it_is_turned_in_the_picture(palm):
    np.testing.assert_allclose(
        palm_faces(turned(palm, 1.0), np.ones(1)), palm_faces(palm, np.ones(1))
    )


def test_a_thumb_rises_or_falls():
    hands = np.zeros((2, 21, 2))
    hands[:, 4, 1] = [-10.0, 10.0]
    assert thumb_rise(hands).tolist() == [1.0, -1.0]


def test_stretched_fingers_and_bent_ones_are_told():
    rng = np.random.default_rng(3)
    told = finger_stretch(draw_hands("point", 50, rng, turn_max_deg=10.0).landmarks_px)
    assert np.median(told[:, 0]) > 0.7
    assert (told[:, 0] > told[:, 1:].max(axis=1)).all()
    assert (np.median(told[:, 1:], axis=0) < -0.3).all()
