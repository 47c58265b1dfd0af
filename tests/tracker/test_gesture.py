import pytest

from tracker.config import Config
from tracker.errors import ConfigError
from tracker.gesture import Gesture, gestures_named


def test_a_gesture_has_a_word_for_messages_and_a_label_for_people():
    assert (Gesture.THUMB_UP.word, Gesture.THUMB_UP.label) == ("thumb_up", "thumb up")


def test_words_with_commas_name_gestures():
    assert gestures_named("palm, wave") == (Gesture.PALM, Gesture.WAVE)


def test_all_names_every_gesture():
    assert set(gestures_named("all")) == set(Gesture)


@pytest.mark.parametrize("words", ["palm fist", "none", "", "all, palm"])
def test_other_words_are_refused_with_what_is_allowed(words):
    with pytest.raises(ValueError, match="allowed is all, or some of palm, fist"):
        gestures_named(words)


def test_the_configuration_refuses_an_unknown_gesture():
    with pytest.raises(ConfigError, match="gesture_call is 'salute'"):
        Config.from_mapping({"gesture_call": "salute"})


def test_hands_are_read_however_they_lean_where_a_thumb_lets_go():
    assert Config().read_lean_max_deg == 75.0
    assert Config(gesture_release="thumb_up").read_lean_max_deg == 180.0
