import numpy as np
import pytest

from tracker.camera import CameraModel
from tracker.containers import Hands
from tracker.ranging.person_range import owner_side, palms_px, range_of_palm_m


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


@pytest.mark.parametrize("azimuth_deg", [0.0, 20.0, 40.0])
@pytest.mark.parametrize("up_m", [0.0, 0.8])
@pytest.mark.parametrize("lens", ["none", "fisheye"])
def test_a_palm_is_as_near_as_it_is_large_wherever_a_lens_shows_it(azimuth_deg, up_m, lens):
    distortion = () if lens == "none" else (-0.12, 0.01, 0.0, 0.0)
    camera = CameraModel(400.0, 400.0, 640.0, 360.0, distortion, lens)
    azimuth = np.radians(azimuth_deg)
    ahead = 2.0 * np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    points = np.zeros((1, 21, 2))
    for landmark, height_m in ((0, up_m), (9, up_m + 0.095)):
        points[0, landmark] = camera.pixels(ahead + np.array([0.0, 0.0, height_m]))[0]
    one = np.ones(1)
    length_px, _ = palms_px(Hands(points, one, one, one.astype(bool), one), camera)
    assert range_of_palm_m(length_px, camera) == pytest.approx([2.0], rel=0.02)


def test_a_landmark_beyond_the_lens_s_range_tells_no_length():
    camera = CameraModel(600.0, 600.0, 640.0, 360.0, (-0.35, 0.15, 0.0, 0.0, -0.03), "plumb_bob")
    points = np.zeros((1, 21, 2))
    points[0, [0, 5, 9, 17]] = [(1195, 300), (1215, 270), (1195, 260), (1175, 275)]
    assert np.isnan(camera.rays(points[0, [5]])).any()
    one = np.ones(1)
    hands = Hands(points, one, one, one.astype(bool), one)
    length_px, breadth_px = palms_px(hands, camera)
    assert 0.5 < range_of_palm_m(np.maximum(length_px, breadth_px), camera)[0] < 2.0


def test_a_hand_without_a_thumb_does_not_say_on_which_side_its_owner_stands():
    assert owner_side(hand_with_thumb_at((np.nan, np.nan))).tolist() == [0.0]
