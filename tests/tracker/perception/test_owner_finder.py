from dataclasses import replace

import numpy as np
import pytest

from tracker.config import Config
from tracker.containers import CameraImage, Hands
from tracker.perception import BodyDetector
from tracker.perception.bodies import Bodies
from tracker.perception.owner_finder import WINDOW_HANDS, OwnerFinder, window_around

HEAD = ("nose", "left_eye", "right_eye", "left_ear", "right_ear")
UP = {"right_elbow": (150, 105), "right_wrist": (148, 70)}


class Watcher:
    """Sees the same people in every window that is wide enough, and remembers the windows."""

    def __init__(self, bodies, width_min=0):
        self.bodies, self.width_min = bodies, width_min
        self.windows = []

    def __call__(self, bgr, window):
        self.windows.append(window)
        return self.bodies if window[2] >= self.width_min else Bodies.none()


def image(number, size=(480, 640)):
    return CameraImage(number * 100_000_000, "", np.zeros((*size, 3), np.uint8))


def look(watcher, hands, images=1, finder=None):
    finder = finder or OwnerFinder(watcher)
    for number in range(images):
        finder.expect(hands)
        bodies = finder.find(image(number))
    return bodies


def test_nobody_is_looked_for_while_no_hand_is_up(upright_hand, body):
    watcher = Watcher(body(**UP))
    assert isinstance(OwnerFinder(watcher), BodyDetector)
    assert len(look(watcher, Hands.none())) == 0
    assert len(look(watcher, upright_hand((148, 70), raised=False))) == 0
    assert watcher.windows == []


def test_the_owner_of_a_raised_hand_is_known_in_the_same_image(upright_hand, body):
    watcher = Watcher(body(**UP))
    bodies = look(watcher, upright_hand((148, 70)))
    assert bodies.age_s.tolist() == [0.0]


def test_the_owner_of_a_pending_hand_is_looked_for_too(upright_hand, body):
    pending = replace(upright_hand((148, 70), raised=False), pending=[True])
    assert len(look(Watcher(body(**UP)), pending)) == 1


def test_a_body_that_was_misread_is_nobodys_owner(upright_hand, body):
    watcher = Watcher(body(**UP, nose=(200, 98)))
    assert len(look(watcher, upright_hand((148, 70)), images=3)) == 0


def looking(watcher, hands, images, patience_s=0.0):
    """Whether the owner of one hand is still looked for, image after image."""
    finder = OwnerFinder(watcher)
    answer = []
    for number in range(images):
        finder.expect(hands)
        finder.find(image(number))
        answer += finder.still_looking(hands, np.array([patience_s])).tolist()
    return answer


def test_an_owner_is_looked_for_until_known_or_in_every_window_and_long_enough(upright_hand, body):
    hand, nobody = upright_hand((148, 70)), Watcher(Bodies.none())
    assert looking(Watcher(body(**UP)), hand, 2) == [False, False]
    assert looking(nobody, hand, 4) == [True, True, False, False]
    assert looking(nobody, hand, 8, patience_s=0.6) == [True] * 6 + [False] * 2


def test_whose_hand_is_only_near_is_not_taken_for_the_owner(upright_hand, body):
    neighbor = Watcher(body(**UP))
    assert looking(neighbor, upright_hand((168, 70)), 4) == [True, True, False, False]


def test_whose_head_is_not_seen_is_not_taken_for_the_owner(upright_hand, body):
    headless = body(**UP, **dict.fromkeys(HEAD))
    assert looking(Watcher(headless), upright_hand((148, 70)), 3) == [True, True, False]
    one_eyed = body(**UP, **{**dict.fromkeys(HEAD), "left_eye": (205, 55)})
    assert looking(Watcher(one_eyed), upright_hand((148, 70)), 3) == [False, False, False]


def test_patience_begins_when_the_owner_is_lost(upright_hand, body):
    watcher, hand = Watcher(body(**UP)), upright_hand((148, 70))
    finder, answer = OwnerFinder(watcher), []
    for number in range(40):
        watcher.bodies = body(**UP) if number < 10 else Bodies.none()
        finder.expect(hand)
        finder.find(image(number))
        answer += finder.still_looking(hand, np.array([1.0])).tolist()
    lost, given_up = answer.index(True), len(answer) - answer[::-1].index(True)
    assert 10 < lost <= 17  # what was seen counts for a second
    assert given_up - lost <= 10
    assert all(answer[lost:given_up])


def test_the_window_shows_so_many_hands_around_the_wrist():
    landmarks = np.zeros((1, 21, 2)) + np.array([320.0, 240.0])
    landmarks[0, 12, 1] -= 20.0
    one = np.ones(1)
    hand = Hands(landmarks, one, one, one.astype(bool), one)
    assert window_around(hand, 10.0, image(0)) == (220, 180, 200, 200)
    assert window_around(hand, 100.0, image(0)) == (0, 0, 640, 480)


def test_a_known_owner_is_looked_at_again_twice_a_second(upright_hand, body):
    watcher = Watcher(body(**UP))
    look(watcher, upright_hand((148, 70)), images=21)
    assert len(watcher.windows) == 4  # in images 0, 6, 12 and 18


def test_other_windows_are_tried_at_once_and_the_one_that_shows_the_owner_is_kept(
    upright_hand, body
):
    hand = upright_hand((148, 70))
    watcher = Watcher(body(**UP), width_min=220)  # 19 px: widths 190, 114, 300
    finder = OwnerFinder(watcher)
    found = []
    for number in range(10):
        finder.expect(hand)
        found.append(len(finder.find(image(number))))
    assert found == [0, 0, 1, 1, 1, 1, 1, 1, 1, 1]
    assert len(watcher.windows) == 4
    assert watcher.windows[2] == watcher.windows[3]


def test_a_hand_whose_owner_no_window_shows_costs_little(upright_hand):
    watcher = Watcher(Bodies.none())
    look(watcher, upright_hand((148, 70)), images=21)
    tries = len(WINDOW_HANDS)
    assert tries < len(watcher.windows) <= tries + 4


def test_one_hand_is_asked_about_in_an_image_those_never_asked_about_first(upright_hand):
    hands = Hands.concatenate(upright_hand((148, 70)), upright_hand((400, 70)))
    watcher = Watcher(Bodies.none())
    look(watcher, hands, images=2)
    assert len(watcher.windows) == 2
    assert watcher.windows[0][0] < 148 < 400 < watcher.windows[1][0] + watcher.windows[1][2]


def test_bodies_grow_older_and_are_forgotten(upright_hand, body):
    watcher = Watcher(body(**UP))
    finder = OwnerFinder(watcher)
    look(watcher, upright_hand((148, 70)), finder=finder)
    assert finder.find(image(4)).age_s == pytest.approx([0.4])
    assert len(finder.find(image(11))) == 0


@pytest.mark.parametrize("odd", [image(3, size=(240, 320)), image(0)], ids=["size", "stamp"])
def test_a_picture_that_does_not_continue_starts_anew(upright_hand, body, odd):
    watcher = Watcher(body(**UP))
    finder = OwnerFinder(watcher)
    finder.expect(upright_hand((148, 70)))
    assert len(finder.find(image(2))) == 1
    assert len(finder.find(odd)) == 0


def test_reset_forgets(upright_hand, body):
    watcher = Watcher(body(**UP))
    finder = OwnerFinder(watcher)
    look(watcher, upright_hand((148, 70)), finder=finder)
    finder.configure(Config())
    finder.reset()
    assert len(finder.find(image(1))) == 0
