from dataclasses import replace

import numpy as np

from tracker.containers import Hands, Tracks
from tracker.gesture import Gesture
from tracker.perception.gestures.customers import CustomerGestures, GestureNews


def tracks_of(stamp_s, ids, hand, gesture=None):
    count = len(ids)
    return Tracks(
        stamp_ns=round(stamp_s * 1e9), id=ids, mean=np.zeros((count, 4)),
        covariance=np.tile(np.eye(4), (count, 1, 1)), existence=np.ones(count),
        confirmed=np.ones(count, bool), raised=np.ones(count, bool),
        raised_since_ns=np.zeros(count), age_s=np.ones(count), unseen_s=np.zeros(count),
        hand=hand, gesture=gesture,
    )  # fmt: skip


def hands_that_say(*gestures):
    count = len(gestures)
    numbers = np.ones(count)
    return Hands(
        np.ones((count, 21, 2)), numbers, numbers, numbers, numbers, gesture=np.array(gestures)
    )


def test_customers_say_what_their_hands_say():
    hands = hands_that_say(Gesture.FIST, Gesture.WAVE)
    tracks = CustomerGestures().add_to(tracks_of(0.0, [3, 5, 6], [1, 0, -1]), hands)
    assert tracks.gesture.tolist() == [Gesture.WAVE, Gesture.FIST, Gesture.NONE]


def test_a_hand_that_is_lost_says_what_it_said_for_half_a_second():
    gestures, hands = CustomerGestures(), hands_that_say(Gesture.WAVE)
    gestures.add_to(tracks_of(0.0, [3], [0]), hands)
    for stamp_s, gesture in ((0.2, Gesture.WAVE), (0.5, Gesture.WAVE), (0.6, Gesture.NONE)):
        lost = gestures.add_to(tracks_of(stamp_s, [3], [-1]), Hands.none())
        assert lost.gesture.tolist() == [gesture]


def test_after_a_reset_a_lost_hand_says_nothing():
    gestures = CustomerGestures()
    gestures.add_to(tracks_of(0.0, [3], [0]), hands_that_say(Gesture.WAVE))
    gestures.reset()
    lost = gestures.add_to(tracks_of(0.1, [3], [-1]), Hands.none())
    assert lost.gesture.tolist() == [Gesture.NONE]


def test_news_are_told_once_and_again_when_they_change():
    news = GestureNews()
    said = [Gesture.NONE, Gesture.PALM, Gesture.PALM, Gesture.WAVE, Gesture.NONE]
    told = [news.after(tracks_of(n, [3], [0], [code])) for n, code in enumerate(said)]
    assert told == [[], ["3 palm"], [], ["3 wave"], ["3 none"]]


def test_who_is_gone_says_none():
    news = GestureNews()
    news.after(tracks_of(0.0, [3, 4], [0, 1], [Gesture.PALM, Gesture.FIST]))
    assert news.after(tracks_of(0.1, [4], [0], [Gesture.FIST])) == ["3 none"]
    assert news.after(Tracks.none(10**9)) == ["4 none"]


def test_of_customers_who_are_not_confirmed_nothing_is_told():
    tracks = tracks_of(0.0, [3], [0], [Gesture.PALM])
    assert GestureNews().after(replace(tracks, confirmed=np.zeros(1, bool))) == []
