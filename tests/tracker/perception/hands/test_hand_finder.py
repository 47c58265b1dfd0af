import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from tracker.config import Config
from tracker.containers import CameraImage
from tracker.perception import HandDetector, HandFinder
from tracker.perception.models import processor_features
from tracker.simulation.rendering.canvas import Canvas
from tracker.simulation.rendering.hand_shape import paint_hand

PHOTOS = Path(__file__).parents[4] / "../shared/data/photos"
MEDIAPIPE = json.loads((Path(__file__).parent / "mediapipe_landmarks.json").read_text("utf-8"))

pytestmark = pytest.mark.model


@pytest.fixture(scope="module", params=[0, 1], ids=["lite", "full"])
def finder(request, model_store):
    """Both complexities, as MediaPipe: on the full picture, hands that point anywhere.

    Tests start from a clean memory.
    """
    config = Config(
        model_complexity=request.param,
        downscale_factor=1,
        search_regions_per_frame=1,
        search_lean_max_deg=180.0,
        model_numbers="fp32",
    )
    return HandFinder(config, model_store)


@pytest.fixture(scope="module")
def full_finder(model_store):
    """Complexity 1, everything else as configured by default."""
    return HandFinder(Config(model_complexity=1), model_store)


def photo(name):
    path = PHOTOS / name
    if not path.is_file():
        pytest.skip(f"the photo {name} is not here (../shared/data/photos)")
    return CameraImage(0, "", cv2.imread(str(path)))


def find_fresh(finder, image):
    finder.reset()
    return finder.find(image)


def blank(width, height, stamp_ns=0):
    return CameraImage(stamp_ns, "", np.full((height, width, 3), 128, np.uint8))


@pytest.mark.parametrize("name", sorted(MEDIAPIPE["photos"]))
def test_landmarks_agree_with_mediapipe(finder, name):
    found = find_fresh(finder, photo(name))
    complexity = finder._config.model_complexity
    expected = np.array(MEDIAPIPE["photos"][name][f"complexity_{complexity}"])
    assert len(found) == len(expected)
    for hand in expected:
        error = np.linalg.norm(found.landmarks_px - hand, axis=-1) / np.ptp(hand, axis=0).max()
        assert np.median(error, axis=-1).min() < 0.004
        assert error.max(axis=-1).min() < 0.015


@pytest.mark.parametrize("gesture", ["palm", "stop", "four"])
@pytest.mark.parametrize("factor", [1, 2])
def test_raised_palms_are_raised(full_finder, gesture, factor):
    image = photo(f"hagrid_gesture_{gesture}.png")
    full_finder.configure(Config(model_complexity=1, downscale_factor=factor))
    found = find_fresh(full_finder, image)
    assert found.raised.tolist() == [True]
    assert 1.6 < found.raise_measure[0] < 2.4
    assert found.score[0] > 0.9


@pytest.mark.parametrize(
    "name",
    [
        "hagrid_gesture_fist.png",
        "hagrid_gesture_like.png",
        "hagrid_gesture_call.png",
        "hagrid_gesture_one.png",
        "onehand10k_33.jpg",  # a hand bent before the face
        "onehand10k_784.jpg",  # a hand that holds something, sideways
    ],
)
@pytest.mark.parametrize("factor", [1, 2])
def test_other_hands_are_found_but_not_raised(full_finder, name, factor):
    image = photo(name)
    full_finder.configure(Config(model_complexity=1, downscale_factor=factor))
    found = find_fresh(full_finder, image)
    assert found.raised.tolist() == [False]


def test_a_hand_that_points_down_measures_below_zero(full_finder):
    # The raised palm upside down, as an arm that hangs.
    upright = photo("hagrid_gesture_palm.png")
    full_finder.configure(Config(model_complexity=1, search_lean_max_deg=180.0))
    found = find_fresh(full_finder, CameraImage(0, "", upright.bgr[::-1, ::-1].copy()))
    assert found.raised.tolist() == [False]
    assert found.raise_measure[0] < -1.5


def test_a_mirrored_hand_is_the_other_hand(full_finder):
    image = photo("hagrid_gesture_palm.png")
    full_finder.configure(Config(model_complexity=1))
    found = find_fresh(full_finder, image)
    mirrored = find_fresh(full_finder, CameraImage(0, "", image.bgr[:, ::-1].copy()))
    assert (found.right[0] > 0.5) != (mirrored.right[0] > 0.5)


def test_a_hand_is_followed_through_the_picture_with_one_search(finder, monkeypatch):
    hand = cv2.resize(photo("hagrid_gesture_palm.png").bgr, (200, 200))
    searches = []
    search = finder._follower._whole
    find = search.find
    monkeypatch.setattr(
        search, "find", lambda *rest, **more: searches.append(1) or find(*rest, **more)
    )
    config = finder._config
    finder.configure(config.replace(max_hands=1))
    finder.reset()
    wrists = []
    for step in range(12):
        picture = np.full((480, 640, 3), hand[2, 2], np.uint8)
        picture[150 : 150 + 200, 50 + 16 * step : 250 + 16 * step] = hand
        found = finder.find(CameraImage(step, "", picture))
        assert found.raised.tolist() == [True]
        wrists.append(found.wrist_px[0])
    finder.configure(config)
    assert len(searches) == 1
    # 16 px a step to the right, give or take the model's noise of 2 % of a hand.
    np.testing.assert_allclose(np.diff(wrists, axis=0), [[16, 0]] * 11, atol=5.0)


def test_two_hands_are_two_rows(full_finder):
    palm, four = (photo(f"hagrid_gesture_{name}.png").bgr for name in ("palm", "four"))
    full_finder.configure(Config(model_complexity=1))
    found = find_fresh(full_finder, CameraImage(0, "", np.hstack([palm, four])))
    assert found.raised.tolist() == [True, True]
    assert sorted(found.wrist_px[:, 0] > palm.shape[1]) == [False, True]


def test_one_thread_finds_what_two_find(model_store):
    picture = np.hstack([photo(f"hagrid_gesture_{name}.png").bgr for name in ("palm", "stop")])
    found = [
        HandFinder(Config(inference_threads=threads), model_store).find(
            CameraImage(0, "", picture)
        )
        for threads in (1, 2)
    ]
    np.testing.assert_allclose(found[0].landmarks_px, found[1].landmarks_px, atol=0.01)


def test_models_change_with_model_complexity(model_store):
    image = photo("hagrid_gesture_palm.png")
    finder = HandFinder(Config(model_complexity=0), model_store)
    lite = finder.find(image)
    finder.configure(Config(model_complexity=1))
    full = finder.find(image)
    fresh = HandFinder(Config(model_complexity=1), model_store).find(image)
    np.testing.assert_array_equal(full.landmarks_px, fresh.landmarks_px)
    assert not np.allclose(full.landmarks_px, lite.landmarks_px, atol=0.01)


@pytest.mark.parametrize("size", [(1, 1), (2, 3), (1, 300), (300, 1), (5, 5)])
def test_tiny_pictures_hold_no_hands(full_finder, size):
    assert len(find_fresh(full_finder, blank(*size))) == 0


def test_an_empty_room_holds_no_hands(finder):
    assert len(find_fresh(finder, blank(640, 480))) == 0


def test_the_finder_is_a_hand_detector(full_finder):
    assert isinstance(full_finder, HandDetector)


def test_a_palm_that_was_up_stays_up_by_the_milder_bound(model_store):
    finder = HandFinder(Config(raise_rule="palm"), model_store)
    image = photo("hagrid_gesture_palm.png")
    assert finder.find(image).raised.tolist() == [True]
    finder.configure(Config(raise_rule="palm", palm_raised_threshold=3.0))
    assert finder.find(image).raised.tolist() == [True]
    assert find_fresh(finder, image).raised.tolist() == [False]


@pytest.mark.parametrize("complexity", [0, 1], ids=["lite", "full"])
def test_8_bits_move_a_drawn_hand_by_less_than_a_fiftieth(model_store, complexity):
    if not processor_features() & {"avx512_vnni", "avx_vnni", "asimddp"}:
        pytest.skip("this processor has no instructions for 8-bit products")
    canvas = Canvas(0.11, 0.32, 700.0)
    skin = (120, 160, 214)
    canvas.paint([[(0.0, -0.04, 0.03), (0.0, 0.08, 0.025)]], skin, 0.02)
    paint_hand(canvas, (0.0, 0.08), 0.1, skin, thumb_right=True, palm_visible=True)
    hand = canvas.sprite().bgra
    picture = np.full((480, 640, 3), 150, np.uint8)
    under = picture[120 : 120 + hand.shape[0], 250 : 250 + hand.shape[1]]
    under[:] = under * (1.0 - hand[..., 3:] / 255.0) + hand[..., :3]
    plain, in_bytes = (
        HandFinder(Config(model_complexity=complexity, model_numbers=numbers), model_store).find(
            CameraImage(0, "", picture)
        )
        for numbers in ("fp32", "int8")
    )
    assert len(plain) == len(in_bytes) == 1
    moved_px = np.linalg.norm(plain.landmarks_px - in_bytes.landmarks_px, axis=-1)
    assert 0.0 < moved_px.mean() < 0.02 * plain.length_px[0]
    assert in_bytes.score[0] > 0.9
