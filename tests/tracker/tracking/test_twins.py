import numpy as np
import pytest

from tracker import Config
from tracker.tracking.modes import Belief
from tracker.tracking.people import People
from tracker.tracking.twins import merge_twins

OLD, YOUNG, BYSTANDER = 4, 9, 0


def silent_and_seen(apart_m=0.3, together_s=0.0, ids=(OLD, YOUNG)):
    """An older track, silent for a second, and a younger one beside it that has just been seen."""
    mean = np.array([[2.0, 0.0, 0.0, 0.0], [2.0, apart_m, 0.0, 0.0]])
    belief = Belief.begin(mean, np.tile(np.eye(4), (2, 1, 1)), 1, 0.1)
    people = People.begin(np.array(ids), belief, 0, 3, np.full(2, 0.9))
    seen_ns = round(together_s * 1e9) + np.array([0, 10**9])
    return people.replace(missing_s=np.array([1.0, 0.0]), seen_ns=seen_ns)


def merged(**changes):
    people = silent_and_seen(**changes)
    return merge_twins(people, np.array([False, True]), Config())


def test_the_older_identity_goes_on_in_the_younger_one_s_place():
    people = merged()
    assert people.id.tolist() == [OLD]
    assert people.belief.mean[0, 0, 1] == 0.3


def test_who_was_followed_beside_the_silent_one_keeps_their_own_identity():
    people = merged(together_s=5.0)
    assert people.id.tolist() == [YOUNG]
    assert people.belief.mean[0, 0, 1] == 0.3


def test_a_customer_who_sets_off_is_followed_for_a_moment_beside_themselves():
    assert merged(together_s=0.3).id.tolist() == [OLD]


@pytest.mark.parametrize(
    ("together_s", "left"), [(0.3, [OLD]), (5.0, [OLD, BYSTANDER])], ids=["new", "known"]
)
def test_a_bystander_who_was_there_before_is_no_twin(together_s, left):
    assert merged(together_s=together_s, ids=(OLD, BYSTANDER)).id.tolist() == left


def test_who_stands_apart_is_no_twin():
    assert merged(apart_m=0.6).id.tolist() == [OLD, YOUNG]
