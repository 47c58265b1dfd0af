import time
from pathlib import Path

import numpy as np
import pytest

from tracker.gesture import Gesture
from tracker.perception.gestures import model
from tracker.perception.gestures.model import SIGNS, SignNetwork, sign_probabilities
from tracker.perception.gestures.over_time import SURE
from tracker.simulation.hand_signs import ANYHOW, HOLDS, draw_hands

#: Not that of the fit, nor of its check.
SEED = 2701


def told(hands):
    chances = sign_probabilities(hands.landmarks_px)
    return np.where(chances.max(axis=1) >= SURE, chances.argmax(axis=1), Gesture.NONE)


@pytest.mark.parametrize("name", ["palm", "fist", "point", "victory", "thumb"])
def test_drawn_signs_of_another_seed_are_told(name):
    hands = draw_hands(name, 500, np.random.default_rng(SEED))
    is_right = told(hands) == hands.gesture
    assert is_right.mean() > 0.9
    assert np.isin(told(hands)[~is_right], [Gesture.NONE]).mean() > 0.9, "unsure, not another sign"


@pytest.mark.parametrize(
    "name", [ANYHOW, *(name for name, hold in HOLDS.items() if hold.gesture == Gesture.NONE)]
)
def test_what_is_no_sign_is_told_as_none(name):
    assert (told(draw_hands(name, 300, np.random.default_rng(SEED))) == Gesture.NONE).mean() > 0.9


def test_a_finger_seen_from_the_side_says_nothing():
    hands = draw_hands("point", 300, np.random.default_rng(SEED), edge_on=True)
    assert (told(hands) == Gesture.NONE).mean() > 0.9


def test_a_thumb_that_points_aside_says_nothing():
    hands = draw_hands("thumb", 100, np.random.default_rng(SEED), turn_max_deg=0.0)
    aside = hands.landmarks_px @ np.array([[0.0, 1.0], [-1.0, 0.0]])
    assert (told(hands) == hands.gesture).mean() > 0.9
    assert (told(hands._replace(landmarks_px=aside)) == Gesture.NONE).all()


def test_probabilities_add_up_to_one():
    hands = draw_hands(ANYHOW, 50, np.random.default_rng(SEED))
    chances = sign_probabilities(hands.landmarks_px)
    assert chances.shape == (50, len(SIGNS))
    np.testing.assert_allclose(chances.sum(axis=1), 1.0, atol=0.01)
    assert sign_probabilities(np.zeros((0, 21, 2))).shape == (0, len(SIGNS))


def test_the_weights_are_a_small_file():
    assert Path(model._WEIGHTS_FILE).stat().st_size < 200_000


def test_weights_come_back_as_they_were_saved(tmp_path):
    network = model.sign_network()
    network.save(tmp_path / "again.npz")
    again = SignNetwork.load(tmp_path / "again.npz")
    for one, other in zip(
        network.weights + network.biases, again.weights + again.biases, strict=True
    ):
        np.testing.assert_array_equal(one, other)


def test_a_hand_costs_little():
    hands = draw_hands("palm", 8, np.random.default_rng(SEED))
    began_s = time.process_time()
    for _ in range(50):
        sign_probabilities(hands.landmarks_px)
    assert (time.process_time() - began_s) / (50 * 8) < 0.0002
