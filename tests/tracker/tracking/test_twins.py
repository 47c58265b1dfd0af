import numpy as np
import pytest

from tracker import Config
from tracker.tracking.appearance import Appearance
from tracker.tracking.modes import Belief
from tracker.tracking.people import People
from tracker.tracking.twins import merge_twins

RED, BLUE, UNKNOWN = np.array([1.0, 0.0]), np.array([0.0, 1.0]), np.zeros(2)
OLD, YOUNG = 4, 9


def silent_and_seen(apart_m=0.3, clothes=(RED, RED)):
    """An older track, silent for a second, and a younger one beside it that has just been seen."""
    mean = np.array([[2.0, 0.0, 0.0, 0.0], [2.0, apart_m, 0.0, 0.0]])
    belief = Belief.begin(mean, np.tile(np.eye(4), (2, 1, 1)), 1, 0.1)
    ids, appearance = np.array([OLD, YOUNG]), Appearance(np.array(clothes))
    people = People.begin(ids, belief, 0, 3, np.full(2, 0.9), appearance)
    return people.replace(missing_s=np.array([1.0, 0.0]))


def merged(config=None, **changes):
    people = silent_and_seen(**changes)
    return merge_twins(people, np.array([False, True]), config or Config(appearance_weight=1.0))


def test_the_older_identity_goes_on_in_the_younger_one_s_place():
    people = merged()
    assert people.id.tolist() == [OLD]
    assert people.belief.mean[0, 0, 1] == 0.3


def test_who_stands_apart_is_no_twin():
    assert merged(apart_m=0.6).id.tolist() == [OLD, YOUNG]


def test_who_wears_other_clothes_is_no_twin():
    assert merged(clothes=(RED, BLUE)).id.tolist() == [OLD, YOUNG]


def test_without_weight_clothes_keep_nobody_apart():
    assert merged(Config(appearance_weight=0.0), clothes=(RED, BLUE)).id.tolist() == [OLD]


@pytest.mark.parametrize("clothes", [(RED, UNKNOWN), (UNKNOWN, RED)], ids=["old", "young"])
def test_twins_wear_what_was_seen_of_either(clothes):
    people = merged(clothes=clothes)
    assert people.id.tolist() == [OLD]
    np.testing.assert_array_equal(people.appearance.histogram, [RED])
