import numpy as np
import pytest

from tracker.containers import Hands
from tracker.ranging.person_range import owner_side


def hand_with_thumb_at(thumb_px):
    """A hand whose little finger is rooted at (200, 200), its palm 30 px long."""
    points = np.full((1, 21, 2), 200.0)
    points[0, 0] = (200.0, 230.0)
    points[0, 4] = thumb_px
    one = np.ones(1)
    return Hands(points, one, one, one.astype(bool), one)


@pytest.mark.parametrize(
    ("roll_deg", "thumb_px"),
    {
        "level": (0.0, (170.0, 200.0)),
        "on its right side": (90.0, (200.0, 230.0)),
        "on its left side": (-90.0, (200.0, 170.0)),
        "upside down": (180.0, (230.0, 200.0)),
    }.values(),
    ids=["level", "on its right side", "on its left side", "upside down"],
)
def test_the_owner_stands_where_the_thumb_points_however_the_camera_is_rolled(roll_deg, thumb_px):
    hand = hand_with_thumb_at(thumb_px)
    assert owner_side(hand, np.radians(roll_deg)) == pytest.approx([1.0])  # to the left
