import numpy as np
import pytest

from tracker.tracking.streaks import Streaks


def run(pattern, raise_streak=2, lower_streak=3):
    streaks, word = Streaks.begin(1), ""
    for letter in pattern:
        streaks = streaks.step(np.array([letter == "x"]), raise_streak, lower_streak)
        word += "R" if streaks.raised[0] else "."
    return word


@pytest.mark.parametrize(
    ("detections", "raised"),
    [
        ("x.x.x.", "......"),  # never two in a row
        ("xx....", ".RRR.."),  # up with the second, down with the third miss
        ("xx..x.x..xx", ".RRRRRRRRRR"),  # two misses in a row do not lower
        ("xx...x.xx", ".RRR....R"),
        ("......", "......"),
    ],
)
def test_algorithm_1_raises_after_2_detections_and_lowers_after_3_misses(detections, raised):
    assert run(detections) == raised


def test_the_streaks_are_parameters():
    assert run("xxx.", raise_streak=3, lower_streak=1) == "..R."


def test_every_track_has_streaks_of_its_own():
    streaks = Streaks.begin(2)
    for first, second in [(True, False), (True, True), (False, True)]:
        streaks = streaks.step(np.array([first, second]), 2, 3)
    assert streaks.raised.tolist() == [True, True]
    assert streaks.detected.tolist() == [0, 2]
    assert streaks.missed.tolist() == [1, 0]
