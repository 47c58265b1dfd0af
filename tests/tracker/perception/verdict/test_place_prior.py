import numpy as np
import pytest

from tracker.perception.verdict.place_prior import BAR_MAX, RAISING_S, STILL_S, PlacePrior

SIZE = np.array([40.0])


def wrist(x=100.0):
    return np.array([[x, 100.0]])


def seconds(prior, from_s, until_s, place=lambda time_s: 100.0):
    """A hand that seems to call all the time, twice a second; the bar at the end."""
    for tick in range(round(2 * from_s), round(2 * until_s)):
        prior.learn(tick * 500_000_000, wrist(place(tick / 2)), SIZE)
    stamp_ns = round(until_s * 1e9)
    return prior.bars(stamp_ns, wrist(place(until_s)), SIZE)[0]


def test_what_calls_for_ever_and_never_moves_meets_a_high_bar():
    assert seconds(PlacePrior(), 0.0, 1.5 * (STILL_S + RAISING_S)) == pytest.approx(
        BAR_MAX, rel=0.1
    )


def test_a_call_of_ordinary_length_meets_none():
    assert seconds(PlacePrior(), 0.0, STILL_S) == 0.0


def test_somebody_who_moves_the_hand_meets_none():
    assert seconds(PlacePrior(), 0.0, 120.0, lambda time_s: 100.0 + 15.0 * (time_s % 8 > 4)) == 0.0


def test_other_places_stay_as_they_are():
    prior = PlacePrior()
    seconds(prior, 0.0, 60.0)
    assert prior.bars(60_000_000_000, wrist(160.0), SIZE).tolist() == [0.0]
    assert prior.highest > 0.0


def test_what_is_gone_is_forgotten_with_time():
    prior = PlacePrior()
    seconds(prior, 0.0, 60.0)
    after = [prior.bars(round(time_s * 1e9), wrist(), SIZE)[0] for time_s in (61, 600, 3600)]
    assert after[0] > after[1] > after[2]
    assert after[2] < 0.1 * BAR_MAX


def test_reset_forgets():
    prior = PlacePrior()
    seconds(prior, 0.0, 60.0)
    prior.reset()
    assert prior.highest == 0.0
