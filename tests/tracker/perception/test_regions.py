import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

from tracker.perception.regions import (
    Regions,
    box_overlap,
    overlap,
    regions_from_alignment,
    regions_from_landmarks,
    regions_from_palms,
    upright_rotation,
)


def palm_keypoints(wrist, middle_root):
    keypoints = np.zeros((1, 7, 2))
    keypoints[0, 0], keypoints[0, 2] = wrist, middle_root
    return keypoints


def upright_hand():
    """Steady landmarks fill x 30..70, y 40..100; fingertips lie far away."""
    points = np.full((1, 21, 2), 1000.0)
    points[0, [0, 1, 2, 3]] = [[50, 100], [40, 90], [35, 80], [30, 70]]
    points[0, [5, 6]] = [[40, 60], [38, 45]]
    points[0, [9, 10]] = [[50, 60], [50, 40]]
    points[0, [13, 14]] = [[60, 60], [62, 45]]
    points[0, [17, 18]] = [[66, 65], [70, 55]]
    return points


@pytest.mark.parametrize(
    ("fingers", "rotation"),
    [((0, -1), 0.0), ((1, 0), np.pi / 2), ((-1, 0), -np.pi / 2), ((1, -1), np.pi / 4)],
    ids=["up", "right", "left", "up and right"],
)
def test_rotation_is_clockwise_from_up(fingers, rotation):
    wrist = np.array([[7.0, 9.0]])
    assert upright_rotation(wrist, wrist + fingers)[0] == pytest.approx(rotation)


def test_a_hand_that_points_down_is_turned_by_half_a_circle():
    assert abs(upright_rotation(np.zeros((1, 2)), np.array([[0.0, 1.0]]))[0]) == pytest.approx(
        np.pi
    )


def test_the_region_of_an_upright_palm_reaches_up_over_the_fingers():
    # Box 20 wide, 40 high around (20, 40); half of 40 up, 2.6 times the longer side.
    region = regions_from_palms(np.array([[10.0, 20, 30, 60]]), palm_keypoints((20, 60), (20, 20)))
    np.testing.assert_allclose(region.center_px, [[20, 20]])
    np.testing.assert_allclose(region.side_px, [104])
    np.testing.assert_allclose(region.rotation_rad, [0])


def test_the_region_of_a_palm_that_points_right_reaches_to_the_right():
    region = regions_from_palms(np.array([[10.0, 20, 30, 60]]), palm_keypoints((0, 40), (40, 40)))
    np.testing.assert_allclose(region.center_px, [[40, 40]], atol=1e-12)
    np.testing.assert_allclose(region.rotation_rad, [np.pi / 2])


def test_the_region_of_landmarks_leaves_fingertips_out():
    # Steady landmarks: 40 wide, 60 high around (50, 70); 6 up, twice the longer side.
    region = regions_from_landmarks(upright_hand())
    np.testing.assert_allclose(region.center_px, [[50, 64]])
    np.testing.assert_allclose(region.side_px, [120])
    np.testing.assert_allclose(region.rotation_rad, [0])


@given(st.floats(-3.1, 3.1), st.floats(0.1, 10), st.floats(-500, 500))
def test_the_region_of_landmarks_turns_grows_and_moves_with_the_hand(angle, scale, shift):
    cos, sin = np.cos(angle), np.sin(angle)
    turn = scale * np.array([[cos, -sin], [sin, cos]])  # clockwise, as y points down
    upright = regions_from_landmarks(upright_hand())
    moved = regions_from_landmarks(upright_hand() @ turn.T + shift)
    np.testing.assert_allclose(moved.center_px, upright.center_px @ turn.T + shift, atol=1e-6)
    np.testing.assert_allclose(moved.side_px, scale * upright.side_px)
    np.testing.assert_allclose(moved.rotation_rad, [angle], atol=1e-9)


def test_overlap_of_boxes_is_intersection_over_union():
    boxes = np.array([[0.0, 0, 2, 2], [1, 0, 3, 2], [5, 5, 6, 6], [1, 1, 1, 1]])
    expected = [[1, 2 / 6, 0, 0]]  # two of six cells; apart; without area
    np.testing.assert_allclose(box_overlap(boxes[:1], boxes), expected)


def test_overlap_of_regions_ignores_their_rotation():
    first = Regions(np.array([[10.0, 10]]), np.array([4.0]), np.array([0.0]))
    second = Regions(np.array([[12.0, 10]]), np.array([4.0]), np.array([0.7]))
    np.testing.assert_allclose(overlap(first, second), [[8 / 24]])
    assert overlap(Regions.none(), second).shape == (0, 1)


def test_no_hands_give_no_regions():
    assert len(regions_from_landmarks(np.zeros((0, 21, 2)))) == 0
    assert len(regions_from_palms(np.zeros((0, 4)), np.zeros((0, 7, 2)))) == 0


def test_regions_can_be_chosen_and_joined():
    regions = Regions(np.arange(6.0).reshape(3, 2), np.arange(3.0), np.arange(3.0))
    chosen = regions[np.array([True, False, True])]
    np.testing.assert_array_equal(chosen.side_px, [0, 2])
    joined = Regions.concatenate(chosen, Regions.none(), regions[1:2])
    np.testing.assert_array_equal(joined.center_px, [[0, 1], [4, 5], [2, 3]])


def test_a_region_is_a_quarter_larger_than_the_circle_around_the_person():
    regions = regions_from_alignment(np.array([[[100.0, 100.0], [140.0, 100.0]]]))
    np.testing.assert_allclose(regions.center_px, [[100, 100]])
    np.testing.assert_allclose(regions.side_px, [100.0])
    np.testing.assert_allclose(regions.rotation_rad, [np.pi / 2])  # lies to the right
