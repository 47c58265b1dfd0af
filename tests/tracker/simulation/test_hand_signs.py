import numpy as np
import pytest

from tracker.gesture import Gesture
from tracker.simulation.hand_signs import ANYHOW, HOLDS, draw_hands


def test_every_sign_of_one_image_is_drawn():
    signs = {hold.gesture for hold in HOLDS.values()}
    assert signs == {
        Gesture.NONE, Gesture.PALM, Gesture.FIST, Gesture.POINT, Gesture.VICTORY, Gesture.THUMB_UP,
    }  # fmt: skip


@pytest.mark.parametrize("name", [*HOLDS, ANYHOW])
def test_the_same_seed_draws_the_same_hands(name):
    one, other = (draw_hands(name, 10, np.random.default_rng(4)) for _ in range(2))
    np.testing.assert_array_equal(one.landmarks_px, other.landmarks_px)
    assert one.landmarks_px.shape == (10, 21, 2)
    assert np.isfinite(one.landmarks_px).all()


def test_thumbs_point_where_they_are_said_to_point():
    hands = draw_hands("thumb", 100, np.random.default_rng(1), noise=(0.0, 1e-9))
    falls_px = hands.landmarks_px[:, 4, 1] - hands.landmarks_px[:, 2, 1]
    np.testing.assert_array_equal(falls_px < 0.0, hands.gesture == Gesture.THUMB_UP)


def test_open_hands_are_as_long_as_asked_for():
    hands = draw_hands(
        "palm", 100, np.random.default_rng(2), turn_max_deg=0.0, size_px=(80.0, 80.1)
    )
    length_px = np.linalg.norm(hands.landmarks_px[:, 12] - hands.landmarks_px[:, 0], axis=-1)
    assert length_px.mean() == pytest.approx(80.0, rel=0.1)
