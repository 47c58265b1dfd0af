import numpy as np
import pytest

from tracker.tracking.life_cycle.streaks import step_streak
from tracker.tracking.people import DETECTED, MISSED, RAISED


def beginning(people):
    """Counts and flags of people who were not seen yet."""
    return np.zeros((10, people), dtype=np.int64), np.zeros((2, people), dtype=bool)


def run(pattern, raise_streak=2, lower_streak=3):
    (counts, flags), word = beginning(1), ""
    for letter in pattern:
        step_streak(counts, flags, 0, letter == "x", raise_streak, lower_streak)
        word += "R" if flags[RAISED, 0] else "."
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
    counts, flags = beginning(2)
    for both in [(True, False), (True, True), (False, True)]:
        for person, is_detected in enumerate(both):
            step_streak(counts, flags, person, is_detected, 2, 3)
    assert flags[RAISED].tolist() == [True, True]
    assert counts[DETECTED].tolist() == [0, 2]
    assert counts[MISSED].tolist() == [1, 0]
