from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from tracker.config import Config
from tracker.containers import CameraImage, Hands, Refusal
from tracker.gesture import Gesture
from tracker.perception import HandFinder
from tracker.perception.gestures.reading import GestureReader
from tracker.simulation.hand_signs import draw_hands

PHOTOS = Path(__file__).parents[4] / "../shared/data/photos"
CONFIG = Config()


def raised_hands(*names):
    """Drawn hands beside each other, all raised."""
    rng = np.random.default_rng(7)
    parts = [draw_hands(name, 1, rng, turn_max_deg=5.0, noise=(0.005, 0.01)) for name in names]
    points = np.concatenate([part.landmarks_px for part in parts])
    points = points + 500.0 * np.arange(1, len(names) + 1)[:, None, None] * [1.0, 0.0]
    right = np.concatenate([part.is_right for part in parts])
    count = len(names)
    return Hands(points, np.full(count, 0.9), right, np.ones(count, bool), np.ones(count))


def read(hands, config=CONFIG, images=4):
    reader = GestureReader()
    for number in range(images):
        seen = reader.read(number * 100_000_000, hands, config)
    return seen


def test_each_hand_says_its_own():
    seen = read(raised_hands("palm", "fist", "victory"))
    assert seen.gesture.tolist() == [Gesture.PALM, Gesture.FIST, Gesture.VICTORY]
    assert seen.raised.all()


def test_a_hand_keeps_what_it_said_when_others_come_and_rows_change():
    reader, both = GestureReader(), raised_hands("palm", "fist")
    for number in range(3):
        reader.read(number * 100_000_000, both[[1]], CONFIG)
    seen = reader.read(300_000_000, both, CONFIG)
    assert seen.gesture.tolist() == [Gesture.NONE, Gesture.FIST]


def test_a_hand_that_is_lost_for_a_moment_still_says_what_it_said():
    reader, fist = GestureReader(), raised_hands("fist")
    for number in range(3):
        reader.read(number * 100_000_000, fist, CONFIG)
    assert len(reader.read(300_000_000, Hands.none(), CONFIG)) == 0
    assert reader.read(400_000_000, fist, CONFIG).gesture.tolist() == [Gesture.FIST]


def test_after_a_reset_nothing_is_known():
    reader, fist = GestureReader(), raised_hands("fist")
    for number in range(3):
        reader.read(number * 100_000_000, fist, CONFIG)
    reader.reset()
    assert reader.read(300_000_000, fist, CONFIG).gesture.tolist() == [Gesture.NONE]


def test_a_hand_of_which_only_the_wrist_was_seen_says_nothing():
    fist = replace(raised_hands("fist"), wrist_only=[True])
    assert read(fist).gesture.tolist() == [Gesture.NONE]


def test_a_sign_that_is_no_call_does_not_raise_a_hand():
    config = Config(gesture_call="palm, wave")
    seen = read(raised_hands("palm", "fist"), config)
    assert seen.raised.tolist() == [True, False]
    assert seen.refusal.tolist() == [Refusal.NO_REASON, Refusal.OTHER_SIGN]


def test_a_hand_that_says_nothing_sure_may_call():
    assert read(raised_hands("relaxed"), Config(gesture_call="palm")).raised.all()


def test_a_lowered_hand_keeps_its_own_reason():
    fist = replace(raised_hands("fist"), raised=[False], refusal=[Refusal.ARM_DOWN])
    seen = read(fist, Config(gesture_call="palm"))
    assert seen.refusal.tolist() == [Refusal.ARM_DOWN]


@pytest.mark.model
@pytest.mark.parametrize("is_mirrored", [False, True], ids=["as it is", "mirrored"])
@pytest.mark.parametrize(
    ("name", "gesture"),
    [("palm", Gesture.PALM), ("stop", Gesture.PALM), ("fist", Gesture.FIST),
     ("one", Gesture.POINT), ("like", Gesture.THUMB_UP), ("call", Gesture.NONE),
     ("four", Gesture.NONE), ("mute", Gesture.NONE)],
)  # fmt: skip
def test_signs_of_real_people_are_told(model_store, name, gesture, is_mirrored):
    path = PHOTOS / f"hagrid_gesture_{name}.png"
    if not path.is_file():
        pytest.skip(f"the photo {path.name} is not here (../shared/data/photos)")
    bgr = cv2.imread(str(path))
    bgr = np.ascontiguousarray(bgr[:, ::-1]) if is_mirrored else bgr
    config = Config(search_lean_max_deg=180.0)
    finder, reader = HandFinder(config, model_store), GestureReader()
    for number in range(4):
        stamp_ns = number * 100_000_000
        hands = reader.read(stamp_ns, finder.find(CameraImage(stamp_ns, "", bgr)), config)
    assert hands.gesture.tolist() == [gesture]
