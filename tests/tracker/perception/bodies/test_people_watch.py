from dataclasses import replace

import numpy as np
import pytest

from tracker.config import Config
from tracker.containers import CameraImage, Hands
from tracker.perception.bodies.bodies import Bodies
from tracker.perception.bodies.people_watch import (
    WINDOW_HANDS,
    PeopleWatch,
    window_around,
)
from tracker.perception.pictures import upright_strips

STRIPS = upright_strips(640, 480)
UP = {"right_elbow": (150, 105), "right_wrist": (148, 70)}


class Look:
    """Sees the same people in every window that is wide enough; notes what it was asked."""

    def __init__(self, bodies, width_min=0):
        self.bodies, self.width_min = bodies, width_min
        self.windows, self.again_px = [], []

    def around(self, bgr, window):
        self.windows.append(window)
        return self.bodies if window[2] >= self.width_min else Bodies.none()

    def again(self, bgr, body):
        self.again_px.append(body.points_px[0, 10].tolist())
        return replace(body, age_s=np.zeros(1))


def picture(number, size=(480, 640)):
    return CameraImage(number * 100_000_000, "", np.full((*size, 3), 60, np.uint8))


NOTHING = np.zeros((0, 4))


def play(look, hands, images, *, calling=True, first=0, watch=None, rests=True, spots=()):
    """Bodies known after each image; things appear at the spots in the second one."""
    watch = watch or PeopleWatch(look)
    calls = np.full(len(hands), calling)
    answer = []
    for number in range(first, first + images):
        moved_px = np.array([(x - 15, y - 15, x + 15, y + 15) for x, y in spots], dtype=float)
        moved_px = moved_px.reshape(-1, 4) if number == 1 else NOTHING
        answer.append(watch.find(picture(number), hands, calls, moved_px, rests=rests))
    return answer


def test_the_owner_of_a_hand_is_known_in_the_same_image(body, upright_hand):
    (known,) = play(Look(body(**UP)), upright_hand((148, 70)), 1)
    assert known.age_s.tolist() == [0.0]


def test_nobody_is_looked_for_without_a_hand(body):
    look = Look(body(**UP))
    play(look, Hands.none(), 10)
    assert look.windows == look.again_px == []


def test_a_body_that_was_misread_is_nobodys_owner(body, upright_hand):
    known = play(Look(body(**UP, nose=(200, 98))), upright_hand((148, 70)), 3)
    assert len(known[-1]) == 0


def test_other_windows_are_tried_at_once(body, upright_hand):
    look = Look(body(**UP), width_min=220)  # 19 px: widths 190, 114, 300
    known = play(look, upright_hand((148, 70)), 4)
    assert [len(bodies) for bodies in known] == [0, 0, 1, 1]
    assert len(look.windows) == len(WINDOW_HANDS)


def test_an_owner_is_read_again_twice_a_second_without_a_search(body, upright_hand):
    look = Look(body(**UP))
    play(look, upright_hand((148, 70)), 21)
    assert len(look.windows) == 1
    assert len(look.again_px) == 4


def test_an_owner_of_a_hand_that_hardly_calls_is_read_less_often(body, upright_hand):
    look = Look(body(**UP))
    play(look, upright_hand((148, 70)), 23, calling=False)
    assert len(look.again_px) == 2


def test_a_hand_whose_owner_no_window_shows_costs_little(upright_hand):
    look, watch = Look(Bodies.none()), None
    watch = PeopleWatch(look)
    hand = upright_hand((148, 70))
    play(look, hand, 2, watch=watch)
    assert watch.is_asked(hand).tolist() == [False]
    play(look, hand, 19, watch=watch, first=2)
    assert watch.is_asked(hand).tolist() == [True]
    assert len(WINDOW_HANDS) < len(look.windows) <= len(WINDOW_HANDS) + 4


def test_an_arm_that_is_up_without_a_hand_is_read_in_each_image(body):
    look = Look(body(**UP))
    known = play(look, Hands.none(), 8, rests=False, spots=[(150, 70)])
    seen = [len(bodies) > 0 for bodies in known]
    first = seen.index(True)
    assert all(bodies.age_s[0] <= 0.1 for bodies in known[first:])


def test_an_arm_that_hangs_is_left_alone(body):
    look = Look(body())
    play(look, Hands.none(), 8, rests=False, spots=[(150, 70)])
    assert look.again_px == []


def test_the_strip_in_which_something_moved_is_looked_at_first(body):
    look = Look(Bodies.none())
    play(look, Hands.none(), 5, rests=False, spots=[(520, 100)])
    assert STRIPS[-1] in look.windows
    assert len(look.windows) <= 2


def test_every_strip_of_a_still_picture_is_looked_at_now_and_then(body):
    look = Look(Bodies.none())
    play(look, Hands.none(), 55, rests=False)
    assert set(look.windows) == set(STRIPS)
    assert len(look.windows) <= 6


def test_strips_wait_while_there_is_no_time():
    look = Look(Bodies.none())
    play(look, Hands.none(), 20, rests=True, spots=[(520, 100)])
    assert look.windows == []


def test_bodies_grow_older_and_are_forgotten(body, upright_hand):
    look = Look(body(**UP))
    watch = PeopleWatch(look)
    play(look, upright_hand((148, 70)), 1, watch=watch)
    nobody = np.zeros(0, dtype=bool)
    later = watch.find(picture(4), Hands.none(), nobody, NOTHING, rests=True)
    assert later.age_s.max() <= 0.4
    look.again = lambda bgr, body: Bodies.none()
    assert len(watch.find(picture(30), Hands.none(), nobody, NOTHING, rests=True)) == 0


@pytest.mark.parametrize("odd", [picture(3, size=(240, 320)), picture(0)], ids=["size", "stamp"])
def test_a_picture_that_does_not_continue_starts_anew(body, upright_hand, odd):
    look = Look(body(**UP))
    watch = PeopleWatch(look)
    play(look, upright_hand((148, 70)), 1, first=2, watch=watch)
    assert len(watch.find(odd, Hands.none(), np.zeros(0, dtype=bool), NOTHING, rests=True)) == 0


def test_the_window_shows_so_many_hands_around_the_wrist(upright_hand):
    hand = upright_hand((320, 240), palm_px=20.0 / 1.9)
    assert window_around(hand, 10.0, picture(0)) == (220, 180, 200, 200)
    assert window_around(hand, 100.0, picture(0)) == (0, 0, 640, 480)


def test_changed_parameters_reach_the_model(body):
    look, told = Look(body(**UP)), []
    look.configure = told.append
    PeopleWatch(look).configure(Config(pose_confidence=0.7))
    assert told == [Config(pose_confidence=0.7)]
