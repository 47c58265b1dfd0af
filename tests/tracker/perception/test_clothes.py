from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
import pytest

from tracker import CameraImage, Config, Hands
from tracker.perception import HandFinder
from tracker.perception.clothes import BINS, clothes_histograms
from tracker.simulation import scene_from_mapping
from tracker.simulation.arm import raised_hand_landmarks
from tracker.simulation.camera_view import CameraView, look_of
from tracker.simulation.hand_shape import LANDMARKS
from tracker.simulation.motion import people_at
from tracker.simulation.projection import Viewpoint
from tracker.simulation.stream import map_from_camera
from tracker.tracking.appearance import hellinger

PHOTOS = Path(__file__).parents[3] / "../shared/data/photos"
RED, GREEN, BLUE, GRAY = (40, 40, 200), (40, 160, 60), (180, 70, 40), (120, 120, 120)


def hand_at(*wrists_px, length_px=60.0, thumb=1.0):
    """Upright hands; the thumb, and so the chest, is to the right for a positive `thumb`."""
    shape = length_px * LANDMARKS * [thumb, -1.0]
    landmarks = shape + np.array(wrists_px, float)[:, None]
    one = np.ones(len(wrists_px))
    return Hands(landmarks, one, one, one.astype(bool), one)


def painted(color):
    return np.full((480, 640, 3), color, np.uint8)


def one_histogram(bgr, hands):
    return clothes_histograms(bgr, hands)[0]


@pytest.mark.parametrize("color", [RED, GREEN, BLUE, GRAY, (0, 0, 0), (255, 255, 255)])
def test_a_histogram_adds_up_to_one(color):
    histogram = one_histogram(painted(color), hand_at((200, 100)))
    assert histogram.shape == (BINS,)
    assert (histogram >= 0.0).all()
    assert histogram.sum() == pytest.approx(1.0)


def test_the_chest_is_on_the_thumb_s_side_below_the_wrist():
    picture = painted(GRAY)
    picture[130:, 330:] = RED
    picture[130:, :310] = BLUE
    red, blue = (one_histogram(painted(color), hand_at((320, 100))) for color in (RED, BLUE))
    right = one_histogram(picture, hand_at((320, 100), thumb=1.0))
    left = one_histogram(picture, hand_at((320, 100), thumb=-1.0))
    assert hellinger(right, red) < 0.1
    assert hellinger(left, blue) < 0.1


def test_other_colors_are_far_apart_and_gray_is_none_of_them():
    seen = [
        one_histogram(painted(color), hand_at((200, 100))) for color in (RED, GREEN, BLUE, GRAY)
    ]
    for one, other in pairwise(seen):
        assert hellinger(one, other) > 0.9


@pytest.mark.parametrize("brightness", [0.5, 0.7, 1.2])
@pytest.mark.parametrize("color", [RED, GREEN, BLUE, GRAY])
def test_light_changes_little(color, brightness):
    rng = np.random.default_rng(3)
    cloth = np.clip(painted(color) * rng.uniform(0.8, 1.0, (480, 640, 1)), 0, 255)
    lit = np.clip(cloth * brightness, 0, 255).astype(np.uint8)
    one, other = (
        one_histogram(picture, hand_at((200, 100))) for picture in (cloth.astype(np.uint8), lit)
    )
    assert hellinger(one, other) < 0.1


def test_a_small_change_of_hue_is_a_small_change_of_the_histogram():
    hues = np.linspace(0, 179, 90)
    seen = []
    for hue in hues:
        hsv = np.full((480, 640, 3), (hue, 150, 180), np.uint8)
        seen.append(one_histogram(cv2.cvtColor(hsv, cv2.COLOR_HSV2BGR), hand_at((200, 100))))
    steps = [hellinger(one, other) for one, other in pairwise([*seen, seen[0]])]
    assert max(steps) < 0.4


@pytest.mark.parametrize(
    "hands",
    [
        hand_at((600, 100)),
        hand_at((200, 440)),
        hand_at((-400, 100)),
        hand_at((200, 100), length_px=6.0),
        hand_at((200, 100), thumb=0.1),
        hand_at((np.nan, 100)),
        hand_at((1e12, 1e12)),
    ],
    ids=["beside", "below", "far beside", "tiny", "edge-on", "nowhere", "far away"],
)
def test_a_chest_that_cannot_be_seen_is_unknown(hands):
    assert np.isnan(clothes_histograms(painted(RED), hands)).all()


def test_no_hands_have_no_clothes():
    assert clothes_histograms(painted(RED), Hands.none()).shape == (0, BINS)


def test_hands_keep_their_order():
    picture = painted(GRAY)
    picture[:, 320:] = RED
    hands = hand_at((100, 100), (400, 100), (100, 440))
    seen = clothes_histograms(picture, hands)
    again = clothes_histograms(picture, hands[[2, 0, 1]])
    np.testing.assert_array_equal(again, seen[[2, 0, 1]])


def guest_histogram(shirt, range_m, seat_m=None):
    """Of a rendered guest straight ahead, from where the hand truly is."""
    person = {
        "id": 1, "seat_m": seat_m, "look": {"shirt": shirt},
        "path": [{"x_m": range_m, "y_m": 0.0}], "raises": [{"from_s": 0.0, "until_s": 1.0}],
    }  # fmt: skip
    wall = {"corners_m": [[6.0, -5.0], [6.0, 5.0]]}
    scene = scene_from_mapping({"duration_s": 1.0, "people": [person], "walls": [wall]})
    view = Viewpoint.of(scene.camera, map_from_camera(scene, 0.5))
    people = people_at(scene, 0.5)
    picture = CameraView(scene, np.random.default_rng(1)).render(view, people)
    sheet = raised_hand_landmarks(look_of(scene.people[0]))
    ahead, left = view.forward_left(people.xy_m[0])
    places = np.stack([np.full(21, ahead), left - sheet[:, 0]], axis=-1)
    one = np.ones(1)
    landmarks = view.pixels(places, sheet[:, 1])[None]
    return one_histogram(picture, Hands(landmarks, one, one, one.astype(bool), one))


def test_a_guest_at_two_distances_is_more_alike_than_two_guests():
    shirts = ["#b5483f", "#3f7f8f", "#d69a2d"]
    near = [guest_histogram(shirt, 1.5) for shirt in shirts]
    far = [guest_histogram(shirt, 4.0, seat_m=0.5) for shirt in shirts]
    distance = np.array([[hellinger(one, other) for other in far] for one in near])
    same = np.eye(3, dtype=bool)
    assert distance[same].max() < 0.5 * distance[~same].min()


@pytest.mark.model
def test_a_person_in_a_darker_smaller_copy_of_a_photo_is_more_alike_than_somebody_else(
    model_store,
):
    at_once = Config(model_complexity=1, search_regions_per_frame=64, small_hand_px=0.0)
    finder = HandFinder(at_once, model_store)
    seen = []
    for name in ("hagrid_samp_00.png", "hagrid_ex_01.png"):
        if not (PHOTOS / name).is_file():
            pytest.skip(f"the photo {name} is not here (../shared/data/photos)")
        photo = cv2.imread(str(PHOTOS / name))
        copy = cv2.resize(photo, None, fx=0.8, fy=0.8, interpolation=cv2.INTER_AREA)
        for bgr in (photo, (0.7 * copy).astype(np.uint8)):
            finder.reset()
            hands = finder.find(CameraImage(0, "", bgr))
            seen.append(one_histogram(bgr, hands[hands.raised]))
    same = [hellinger(seen[0], seen[1]), hellinger(seen[2], seen[3])]
    other = [hellinger(seen[row], seen[column]) for row in (0, 1) for column in (2, 3)]
    assert max(same) < 0.5 * min(other)
