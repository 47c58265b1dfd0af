"""Who sits is remembered while the hand is down, and forgotten once they walk."""

from dataclasses import replace

import numpy as np
import pytest

from tracker import Hands, Measurements, PersonTracker
from tracker.ranging import Postures

AT_M = np.array([[2.0, 1.0]])


@pytest.fixture
def customer():
    """One customer at (2, 1) who calls, with the only hand of the image."""
    tracker = PersonTracker(compiled=False)
    for number in range(3):
        seen = Measurements.cartesian(AT_M, 0.01 * np.eye(2), hand=0)
        tracks = tracker.step(number * 10**8, seen)
    return tracks


def hand(seated):
    one = np.ones(1)
    return Hands(np.zeros((1, 21, 2)), one, one, one > 0, one, seated=np.array([seated]))


def test_a_posture_is_remembered_while_the_hand_is_down(customer):
    postures = Postures()
    postures.learn(customer, hand(0.8))
    postures.learn(replace(customer, hand=np.array([-1])), Hands.none())
    assert postures.at(AT_M, 0.45).tolist() == [0.8]
    assert np.isnan(postures.at(AT_M + 0.5, 0.45)).all()


def test_a_look_that_does_not_tell_changes_nothing_and_one_that_does_counts(customer):
    postures = Postures()
    postures.learn(customer, hand(1.0))
    postures.learn(customer, hand(np.nan))
    assert postures.at(AT_M, 0.45).tolist() == [1.0]
    postures.learn(customer, hand(0.0))
    assert postures.at(AT_M, 0.45).tolist() == [0.0]


def test_whoever_walks_or_is_gone_sits_no_more(customer):
    postures = Postures()
    postures.learn(customer, hand(1.0))
    walking = customer.mean + np.array([0.0, 0.0, 1.0, 0.0])
    postures.learn(replace(customer, mean=walking), hand(1.0))
    assert np.isnan(postures.at(AT_M, 0.45)).all()
    postures.learn(customer, hand(1.0))
    postures.learn(customer[:0], Hands.none())
    assert np.isnan(postures.at(AT_M, 0.45)).all()


def test_nobody_known_and_no_place_asked():
    assert np.isnan(Postures().at(AT_M, 0.45)).all()
    assert Postures().at(np.zeros((0, 2)), 0.45).shape == (0,)
