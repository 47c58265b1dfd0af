import numpy as np
import pytest

from tracker.simulation.figure import Look, bend_arm, paint_figure, raised_hand_landmarks
from tracker.simulation.hand_shape import HAND_LENGTH_M, hand_landmarks

STANDS, SITS = Look(), Look(seat_m=0.5)


def test_a_hand_is_as_long_as_it_should_be():
    hand = hand_landmarks((0.4, 1.5), 0.3, thumb_right=True)
    assert np.linalg.norm(hand[12] - hand[0]) == pytest.approx(HAND_LENGTH_M, rel=2e-3)
    np.testing.assert_allclose(hand[0], [0.4, 1.5])


@pytest.mark.parametrize("look", [STANDS, SITS], ids=["stands", "sits"])
@pytest.mark.parametrize("from_behind", [False, True], ids=["front", "back"])
def test_the_raised_hand_points_up_beside_the_body(look, from_behind):
    hand = raised_hand_landmarks(look, from_behind=from_behind)
    palm = np.linalg.norm(hand[9] - hand[0])
    assert (hand[12, 1] - hand[0, 1]) / palm > 1.6  # an open hand, by the palm rule
    assert 0.25 < abs(hand[0, 0]) < 0.5
    # A right hand is at the left of whoever faces its owner, and its thumb toward the head.
    assert np.sign(hand[0, 0]) == (1.0 if from_behind else -1.0)
    assert abs(hand[4, 0]) < abs(hand[20, 0])


def test_the_left_hand_mirrors_the_right():
    right, left = raised_hand_landmarks(Look()), raised_hand_landmarks(Look(right_handed=False))
    np.testing.assert_allclose(left, right * (-1.0, 1.0))


@pytest.mark.parametrize("look", [STANDS, SITS], ids=["stands", "sits"])
def test_a_lowered_hand_points_down(look):
    assert abs(bend_arm(look, 0.0, -1.0).hand_rad) > np.pi / 2


def test_a_seat_lowers_head_and_hand():
    drop = raised_hand_landmarks(STANDS)[0, 1] - raised_hand_landmarks(SITS)[0, 1]
    assert drop == pytest.approx(0.9 - 0.06 - 0.5)


def test_a_figure_is_painted_once_per_height_of_the_arm():
    low, high = paint_figure(STANDS, (0.0, 1.0), px_per_m=300.0)
    for sprite in (low, high):
        color, opacity = sprite.bgra[..., :3], sprite.bgra[..., 3:]
        assert opacity.max() == 255
        assert (color <= opacity).all()  # already multiplied
    skin = high.bgra[..., 3] > 0
    wrist = raised_hand_landmarks(STANDS)[0] * (1.0, -1.0) * high.px_per_m + high.anchor_px
    column, row = wrist.astype(int)
    assert skin[row, column]
    # The head is where a grown person's is, give or take the hair.
    top_m = low.anchor_px[1] / low.px_per_m
    assert top_m == pytest.approx(STANDS.stature_m, abs=0.05)
