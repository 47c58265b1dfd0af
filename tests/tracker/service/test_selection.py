import numpy as np
import pytest

from tracker import Config, Measurements, PersonTracker
from tracker.service import Command, Verb

NOISE = 0.05**2 * np.eye(2)
NEAR, FAR = (1.0, 0.0), (3.0, 0.5)


def run(tracker, frames):
    chosen = []
    for number, points in enumerate(frames):
        claims = Measurements.cartesian(np.array(points, float).reshape(-1, 2), NOISE)
        chosen.append(tracker.step(number * 100_000_000, claims).selected_id)
    return chosen


@pytest.mark.parametrize(("selection", "expected"), [("first", 1), ("nearest", 2), ("newest", 2)])
def test_the_selection_chooses_when_the_chosen_one_s_hand_goes_down(selection, expected):
    # Nobody is chosen until both hands count: the far one since frame 1, the near one since 4.
    tracker = PersonTracker(Config(selection=selection))
    run(tracker, [[FAR]] * 3 + [[FAR, NEAR]] * 3)
    tracker.calls.reset()
    tracks = tracker.step(10**9, Measurements.cartesian([FAR, NEAR], NOISE))
    assert tracks.selected_id == expected


@pytest.mark.parametrize("selection", ["first", "nearest", "newest"])
def test_the_chosen_customer_stays_chosen_while_the_hand_is_up(selection):
    tracker = PersonTracker(Config(selection=selection))
    assert run(tracker, [[FAR]] * 3 + [[FAR, NEAR]] * 9)[-1] == 1


def test_the_next_customer_is_chosen_when_the_first_hand_goes_down():
    chosen = run(PersonTracker(), [[FAR, NEAR]] * 4 + [[NEAR]] * 3)
    assert chosen == [None, 1, 1, 1, 1, 1, 2]


def test_the_selection_can_be_held_after_the_hand_went_down():
    tracker = PersonTracker(Config(selection_hold_s=0.5))
    chosen = run(tracker, [[FAR]] * 3 + [[]] * 10)
    # The hand counts as raised until frame 4 (three misses: 3, 4, 5), then 0.5 s until frame 9.
    assert chosen == [None, *[1] * 9, *[None] * 3]


def test_a_released_customer_makes_room_for_the_next():
    tracker = PersonTracker()
    run(tracker, [[FAR, NEAR]] * 4)
    assert tracker.calls.obey(Command(Verb.RELEASE)).text == "customer 1 is released"
    tracks = tracker.step(10**9, Measurements.cartesian([FAR, NEAR], NOISE))
    assert tracks.selected_id == 2
