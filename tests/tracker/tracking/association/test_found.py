import numpy as np
import pytest

from tracker import Measurements
from tracker.tracking.association.found import NOBODY, NOT_IN, nothing_found, take
from tracker.tracking.association.gating import Pairs
from tracker.tracking.sensing.claims import claims_of

NONE = np.zeros(0)


@pytest.fixture
def claims():
    """A raised hand, the same body's lowered one, and somebody in the scan."""
    measured = Measurements.cartesian(
        np.zeros((3, 2)), np.eye(2), raised=[True, False, False], hand=[4, 5, -1]
    )
    return claims_of(measured)


def taken(found, claims, *whose, probability=0.8):
    """After a round in which these pairs of track and claim were chosen, track by track."""
    track, claim = np.array(whose, dtype=int).reshape(-1, 2).T
    chosen = np.full(len(found.hand), -1)
    chosen[track] = np.arange(len(track))
    pairs = Pairs(track, claim, NONE, NONE, NONE)
    take(found, chosen, np.full(len(track), probability), pairs, claims)
    return found


def test_before_the_first_round_what_came_in_is_nobody_s():
    found = nothing_found(2, 3, np.array([0, 2]))
    assert found.owner.tolist() == [NOBODY, NOT_IN, NOBODY]
    assert found.hand.tolist() == [-1, -1]
    assert not found.is_called.any()
    assert not found.certainty.any()


def test_a_raised_hand_calls_and_shows_and_anything_else_shows(claims):
    found = taken(nothing_found(3, 3, np.arange(3)), claims, (0, 2), (2, 0))
    assert found.owner.tolist() == [2, NOBODY, 0]
    assert found.is_called.tolist() == [False, False, True]
    assert found.certainty == pytest.approx([0.8, 0.0, 0.8])
    assert found.hand.tolist() == [-1, -1, 4]


def test_the_hand_of_who_has_called_stays_the_raised_one(claims):
    found = nothing_found(1, 3, np.arange(3))
    for row in (0, 1, 2):
        taken(found, claims, (0, row))
    assert found.hand.tolist() == [4]
    assert found.owner.tolist() == [0, 0, 0]


def test_a_lowered_hand_is_theirs_who_did_not_call(claims):
    assert taken(nothing_found(1, 3, np.arange(3)), claims, (0, 1)).hand.tolist() == [5]


def test_who_is_found_more_than_once_is_as_certain_as_at_best(claims):
    found = nothing_found(1, 3, np.arange(3))
    for row, probability in ((0, 0.5), (1, 0.9), (2, 0.7)):
        taken(found, claims, (0, row), probability=probability)
    assert found.certainty == pytest.approx([0.9])
