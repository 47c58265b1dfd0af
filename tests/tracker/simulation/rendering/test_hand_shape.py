import numpy as np
import pytest

from tracker.simulation.rendering.hand_shape import HAND_LENGTH_M, hand_landmarks


@pytest.mark.parametrize("length_m", [0.14, HAND_LENGTH_M, 0.2])
def test_a_hand_is_as_long_as_it_should_be(length_m):
    hand = hand_landmarks((0.4, 1.5), 0.3, thumb_right=True, length_m=length_m)
    assert np.linalg.norm(hand[12] - hand[0]) == pytest.approx(length_m, rel=2e-3)
    np.testing.assert_allclose(hand[0], [0.4, 1.5])


def test_closed_fingers_keep_their_length_and_lie_side_by_side():
    wide, closed = (
        hand_landmarks((0.0, 0.0), 0.0, thumb_right=True, spread=spread) for spread in (1.0, 0.0)
    )
    for root, tip in ((5, 8), (9, 12), (13, 16), (17, 20), (1, 4)):
        lengths = [np.linalg.norm(hand[tip] - hand[root]) for hand in (wide, closed)]
        assert lengths[0] == pytest.approx(lengths[1])
    for root, tip in ((5, 8), (13, 16), (17, 20)):
        assert closed[tip, 0] == pytest.approx(closed[root, 0])  # straight up
    assert np.ptp(closed[[8, 12, 16, 20], 0]) < 0.75 * np.ptp(wide[[8, 12, 16, 20], 0])
