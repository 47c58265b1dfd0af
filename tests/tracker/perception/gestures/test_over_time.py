import numpy as np
import pytest

from tracker.gesture import Gesture
from tracker.perception.gestures.model import SIGNS
from tracker.perception.gestures.over_time import (
    PRIOR,
    Look,
    SigningHand,
    count_turns,
    update_signs,
)

SIZE_PX = 50.0


def chances_of(gesture, probability=0.94):
    chances = np.full(len(SIGNS), (1.0 - probability) / (len(SIGNS) - 1))
    chances[gesture] = probability
    return chances


def show(
    signs,
    *,
    x=lambda t: 0.0,
    stretch=lambda t: 0.9,
    raised=True,
    faces=0.7,
    upright=True,
    wrist_only=False,
):
    """What a hand says after each of these signs, ten images a second."""
    hand, said = SigningHand(), []
    for number, gesture in enumerate(signs):
        t = number / 10
        wrist = np.array([300.0 + SIZE_PX * x(t), 200.0])
        tip = np.full(2, np.nan) if wrist_only else wrist - [0.0, SIZE_PX]
        look = Look(
            number * 100_000_000, wrist, tip, SIZE_PX,
            np.nan if wrist_only else stretch(t), upright, faces, raised,
        )  # fmt: skip
        chances = np.full(len(SIGNS), np.nan) if wrist_only else chances_of(gesture)
        said.append(hand.see(look, chances))
    return said


def swings(hands, period_s):
    return lambda t: hands / 2 * np.sin(2 * np.pi * t / period_s)


def test_a_sign_is_named_after_two_images():
    assert show([Gesture.FIST] * 3) == [Gesture.NONE, Gesture.FIST, Gesture.FIST]


def test_a_single_odd_image_changes_nothing():
    said = show([Gesture.FIST] * 8 + [Gesture.PALM] + [Gesture.FIST] * 5)
    assert set(said[2:]) == {Gesture.FIST}


def test_another_sign_is_named_within_half_a_second():
    said = show([Gesture.FIST] * 10 + [Gesture.VICTORY] * 5)
    assert said[-1] == Gesture.VICTORY


def test_images_that_say_nothing_leave_nothing():
    assert show([Gesture.FIST] * 8 + [Gesture.NONE] * 6)[-1] == Gesture.NONE


def test_unsure_images_name_nothing():
    hand = SigningHand()
    for number in range(20):
        look = Look(number * 100_000_000, np.zeros(2), np.zeros(2), 50.0, 0.0, True, 0.0, False)
        assert hand.see(look, PRIOR) == Gesture.NONE


def test_a_belief_that_is_not_fed_fades_to_the_prior():
    sure = update_signs(PRIOR, 0.0, chances_of(Gesture.PALM))
    later = update_signs(sure, 60.0, np.full(len(SIGNS), np.nan))
    np.testing.assert_allclose(later, PRIOR, atol=1e-6)


@pytest.mark.parametrize(
    ("values", "turns"),
    [([], 0), ([0, 1, 2], 0), ([0, 2, 0], 1), ([0, 2, 0, 2], 2),
     ([0, 2, 1.7, 2.5, 0, np.nan, 2], 2), ([5, 3, 5], 1), ([0, 0.4, 0, 0.4, 0], 0)],
    ids=["nothing", "one way", "back", "and again", "small step and gap", "down first", "noise"],
)  # fmt: skip
def test_turns_are_counted(values, turns):
    assert count_turns(values, 0.5) == turns


def test_an_open_hand_that_swings_waves():
    said = show([Gesture.PALM] * 20, x=swings(0.8, 1.0), raised=False)
    assert said[-1] == Gesture.WAVE


def test_a_hand_that_calls_may_wave_slowly():
    slow = swings(2.0, 3.0)
    assert show([Gesture.PALM] * 40, x=slow)[-1] == Gesture.WAVE
    assert Gesture.WAVE not in show([Gesture.PALM] * 40, x=slow, raised=False)


def test_an_arm_without_a_hand_waves_as_well():
    assert show([Gesture.NONE] * 20, x=swings(1.0, 1.0), wrist_only=True)[-1] == Gesture.WAVE


@pytest.mark.parametrize(
    "how",
    [{"stretch": lambda t: -0.5}, {"upright": False}, {"x": lambda t: 2.0 * t},
     {"x": swings(0.2, 1.0)}],
    ids=["fist", "hanging", "passes by", "trembles"],
)  # fmt: skip
def test_this_is_no_wave(how):
    words = {"x": swings(0.8, 1.0)} | how
    assert Gesture.WAVE not in show([Gesture.NONE] * 30, **words)


def test_a_palm_held_still_that_does_not_call_says_stop():
    said = show([Gesture.PALM] * 12, raised=False)
    assert said[6] == Gesture.PALM
    assert said[-1] == Gesture.STOP


@pytest.mark.parametrize(
    "how",
    [{"raised": True}, {"faces": -0.7}, {"x": lambda t: 0.5 * t}],
    ids=["calls", "shows its back", "moves"],
)
def test_this_is_a_palm_and_no_stop(how):
    assert show([Gesture.PALM] * 12, **({"raised": False} | how))[-1] == Gesture.PALM


def test_fingers_that_stretch_and_bend_again_and_again_say_come():
    said = show([Gesture.NONE] * 30, stretch=lambda t: np.cos(2 * np.pi * t / 1.0), raised=False)
    assert said[-1] == Gesture.COME


def test_a_hand_that_opens_once_does_not_say_come():
    said = show([Gesture.NONE] * 30, stretch=lambda t: 1.0 if t > 1.5 else -1.0)
    assert Gesture.COME not in said


def test_a_hand_that_moves_about_as_it_opens_and_closes_does_not_say_come():
    said = show([Gesture.NONE] * 30, stretch=lambda t: np.cos(2 * np.pi * t), x=lambda t: 1.5 * t)
    assert Gesture.COME not in said
