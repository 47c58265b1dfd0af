import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker import Config, Measurements, PersonTracker
from tracker.tracking.association.gating import Pairs
from tracker.tracking.instant import Instant
from tracker.tracking.life_cycle.life_cycle import (
    LOST_STD_M,
    believe,
    count_person,
    fade,
    is_still_there,
)
from tracker.tracking.people import (
    BORN_NS,
    CALLED_NS,
    CONFIRMED,
    DETECTED,
    DETECTIONS,
    EXISTENCE,
    MISSED,
    MISSING_S,
    RAISED,
    RAISED_SINCE_NS,
    SEEN_NS,
)
from tracker.tracking.sensing.view import view_numbers
from tracker.tracking.settings import settings_of

pytestmark = pytest.mark.usefixtures("machine_code")

NOISE = 0.08**2 * np.eye(2)
SECOND_NS = 10**9
EVERYWHERE = view_numbers(None)


def at(*points, raised=True):
    return Measurements.cartesian(np.array(points, float).reshape(-1, 2), NOISE, raised=raised)


def run(tracker, frames, start=0):
    for number, claims in enumerate(frames, start):
        tracks = tracker.step(number * 100_000_000, claims)
    return tracks


@pytest.fixture(scope="session")
def person_of(people_of):
    """One person with these numbers about them."""

    def person(existence=0.5, missing_s=0.0, counts=None, id=1):
        people = people_of(np.zeros((1, 4)), 0.01 * np.eye(4), ids=[id])
        people.spans[[EXISTENCE, MISSING_S], 0] = existence, missing_s
        for row, value in (counts or {}).items():
            people.counts[row, 0] = value
        return people

    return person


@pytest.fixture
def believed(people_of):
    """Existence after a frame in which each of these people has a pair, or NaN for none."""

    def existence(before, log_odds, chance):
        log_odds = np.asarray(log_odds)
        people = people_of(np.zeros((len(before), 4)), np.eye(4))
        people.spans[EXISTENCE] = before
        track = np.flatnonzero(~np.isnan(log_odds))
        chosen = np.full(len(before), -1)
        chosen[track] = np.arange(len(track))
        pairs = Pairs(track, track, np.zeros((0, 1)), np.zeros(0), log_odds[track])
        believe(people, chosen, pairs, np.full(len(before), chance))
        return people.spans[EXISTENCE]

    return existence


def test_existence_follows_bayes_rule_in_odds(believed):
    # log-odds of a pair are against a miss as well; existence leaves the miss out.
    log_odds = np.log([4.0 / 0.2, 8.0 / 0.2])
    assert believed([0.5, 0.2], log_odds, 0.8) == pytest.approx([0.8, 2.0 / 3.0])


def test_what_is_assigned_is_no_evidence_against_anybody(believed):
    assert believed([0.5, 0.3], [-3.0, np.nan], 0.9) == pytest.approx([0.5, 0.3])


def test_one_frame_makes_nobody_more_than_a_hundred_times_likelier(believed):
    assert believed([0.5], [1e300], 0.9) == pytest.approx([100.0 / 101.0])


@given(
    before=st.floats(0.0, 1.0 - 1e-6),
    log_odds=st.floats(-1e300, 1e300),
    chance=st.floats(0.02, 0.99),
    dt_s=st.floats(0.0, 1e6),
)
def test_existence_stays_a_probability(person_of, before, log_odds, chance, dt_s):
    people = person_of(before)
    fade(people, people.covariance, dt_s, np.ones(1), 2.0)
    assert 0.0 <= people.spans[EXISTENCE, 0] <= before
    one = np.zeros(1, dtype=int)
    pairs = Pairs(one, one, np.zeros((1, 1)), np.zeros(1), np.array([log_odds]))
    believe(people, one, pairs, np.array([chance]))
    assert 0.0 <= people.spans[EXISTENCE, 0] < 1.0


def test_silence_tells_only_where_somebody_would_be_seen(people_of):
    people = people_of(np.zeros((3, 4)), 1e-12 * np.eye(4))
    people.spans[EXISTENCE] = 0.8
    fade(people, people.covariance, 0.5, np.array([1.0, 0.5, 0.0]), 2.0)
    assert people.spans[MISSING_S] == pytest.approx([0.5, 0.25, 0.0], abs=1e-6)
    expected = 0.8 * np.exp([-0.25, -0.125, 0.0])
    assert people.spans[EXISTENCE] == pytest.approx(expected, rel=1e-6)


def test_who_might_be_anywhere_is_as_good_as_gone_seen_or_not(people_of):
    people = people_of(np.zeros((1, 4)), (2.0 * LOST_STD_M) ** 2 * np.eye(4))
    fade(people, people.covariance, 0.5, np.zeros(1), 2.0)
    assert people.spans[MISSING_S, 0] == 0.5


def count(people, is_called, certainty=1.0, *, camera_looked=True, config=None):
    instant = Instant(SECOND_NS, 0.1, 1, -1, EVERYWHERE, EVERYWHERE, False, camera_looked)
    count_person(people, 0, is_called, certainty, instant, settings_of(config or Config()))


def test_a_raised_hand_counts_everywhere(person_of):
    people = person_of(missing_s=0.5)
    people.recent[0] = [False, True, False, False, False]
    count(people, True, config=Config(raise_streak=1, confirm_detections=2))
    assert people.recent[0].tolist() == [True, False, True, False, False]
    stamps = people.counts[[SEEN_NS, CALLED_NS, RAISED_SINCE_NS], 0]
    assert stamps.tolist() == [SECOND_NS] * 3
    assert people.counts[DETECTIONS, 0] == 1
    assert people.flags[[RAISED, CONFIRMED], 0].all()
    assert people.spans[MISSING_S, 0] == 0.0


def test_a_hand_that_stays_up_keeps_the_stamp_of_when_it_came_up(person_of):
    people = person_of(counts={RAISED_SINCE_NS: 5, DETECTED: 9})
    people.flags[RAISED] = True
    count(people, True)
    assert people.counts[RAISED_SINCE_NS, 0] == 5


def test_between_two_images_nobody_s_hand_is_missed(person_of):
    people = person_of(counts={CALLED_NS: 3})
    people.recent[0, 0] = True
    count(people, False, camera_looked=False)
    assert people.recent[0].tolist() == [True, False, False, False, False]
    assert people.counts[MISSED, 0] == 0
    assert people.counts[[SEEN_NS, CALLED_NS], 0].tolist() == [SECOND_NS, 3]
    count(people, False)
    assert people.recent[0].tolist() == [False, True, False, False, False]
    assert people.counts[MISSED, 0] == 1


@pytest.mark.parametrize(("certainty", "left_s"), [(0.0, 0.8), (0.75, 0.2), (1.0, 0.0)])
def test_what_may_well_be_somebody_else_s_does_not_end_a_silence(person_of, certainty, left_s):
    people = person_of(missing_s=0.8, counts={SEEN_NS: 7})
    count(people, False, certainty)
    assert people.spans[MISSING_S, 0] == pytest.approx(left_s)
    assert people.counts[SEEN_NS, 0] == (SECOND_NS if certainty else 7)


@pytest.mark.parametrize(
    ("recent", "stays"),
    [("x....", True), (".x...", True), ("...x.", True), ("....x", False), (".....", False)],
)
def test_a_tentative_track_goes_once_it_cannot_be_confirmed_any_more(person_of, recent, stays):
    people = person_of()
    people.recent[0] = [letter == "x" for letter in recent]
    config = Config(confirmation="m_of_n", confirm_window=5, confirm_detections=2)
    assert is_still_there(people, 0, 0, settings_of(config)) == stays


@pytest.mark.parametrize(
    ("missing_s", "detections", "called_s", "stays"),
    [
        (2.0, 9, 100, True),
        (2.1, 9, 100, False),
        (0.8, 2, 100, True),  # two fifths of mature
        (0.9, 2, 100, False),
        (0.0, 9, 41, True),
        (0.0, 9, 39, False),
    ],
)
def test_a_customer_stays_as_long_as_something_shows_them_and_they_call(
    person_of, missing_s, detections, called_s, stays
):
    counts = {DETECTIONS: detections, CALLED_NS: called_s * SECOND_NS}
    people = person_of(missing_s=missing_s, counts=counts)
    people.flags[CONFIRMED] = True
    config = Config(delete_after_s=2.0, mature_detections=5, forget_after_s=60.0)
    assert is_still_there(people, 0, 100 * SECOND_NS, settings_of(config)) == stays


@pytest.mark.parametrize(
    ("known_s", "missing_s", "stays"),
    [(0.5, 0.5, True), (0.5, 0.6, False), (9.0, 2.0, True), (9.0, 2.1, False)],
)
def test_a_bystander_is_remembered_for_as_long_as_it_was_seen(
    person_of, known_s, missing_s, stays
):
    counts = {BORN_NS: 0, SEEN_NS: int(known_s * SECOND_NS)}
    people = person_of(id=-1, missing_s=missing_s, counts=counts)
    settings = settings_of(Config(delete_after_s=2.0))
    assert is_still_there(people, 0, 100 * SECOND_NS, settings) == stays


def test_existence_can_make_a_customer_instead_of_counting():
    tracker = PersonTracker(Config(confirmation="existence", confirm_existence=0.9))
    assert run(tracker, [at((2, 1))]).confirmed.tolist() == [False]
    assert run(tracker, [at((2, 1))], start=1).confirmed.tolist() == [True]


def test_a_tentative_customer_fades_away_where_existence_decides():
    tracker = PersonTracker(Config(confirmation="existence"))
    run(tracker, [at((2, 1))])
    assert len(run(tracker, [Measurements.none()] * 10, start=1)) == 0


def test_a_customer_of_few_detections_goes_sooner():
    lived = {}
    for detections in (2, 5):
        tracker = PersonTracker(Config(delete_after_s=2.05, mature_detections=5))
        run(tracker, [at((2, 1))] * detections)
        number = detections
        while len(run(tracker, [Measurements.none()], start=number)):
            number += 1
        lived[detections] = number - detections
    assert lived == {2: 8, 5: 20}


def test_a_person_tracked_twice_is_one_with_the_older_identity():
    tracker = PersonTracker()
    run(tracker, [at((2, 1))] * 6)
    # A step aside beyond every gate makes somebody new; who then comes back over the old place
    # is the old one, who has been silent since.
    path = [(2.0 - 0.05 * step, 1.9 - 0.1 * step) for step in range(14)]
    tracks = run(tracker, [at(point) for point in path], start=6)
    assert len(tracks) == 1
    assert tracks.id.tolist() == [1]
    assert tracks.raised.tolist() == [True]


def test_two_people_side_by_side_stay_two_while_both_are_seen():
    tracker = PersonTracker(Config(same_person_distance_m=0.3))
    tracks = run(tracker, [at((2, 0.2), (2, -0.2))] * 20)
    assert tracks.id.tolist() == [1, 2]
