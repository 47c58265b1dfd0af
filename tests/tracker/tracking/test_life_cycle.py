import numpy as np
import pytest

from tracker import Config, Measurements, PersonTracker
from tracker.tracking.life_cycle import believe

NOISE = 0.08**2 * np.eye(2)


def at(*points, raised=True):
    return Measurements.cartesian(np.array(points, float).reshape(-1, 2), NOISE, raised=raised)


def run(tracker, frames, start=0):
    for number, claims in enumerate(frames, start):
        tracks = tracker.step(number * 100_000_000, claims)
    return tracks


def test_existence_follows_bayes_rule_in_odds():
    found = believe(np.array([0.5, 0.2]), np.log([4.0, 8.0]))
    assert found == pytest.approx([0.8, 2.0 / 3.0])


def test_what_is_assigned_is_no_evidence_against_anybody():
    assert believe(np.array([0.5]), np.array([-3.0])) == pytest.approx([0.5])


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
        tracker = PersonTracker(Config(delete_after_s=2.0, mature_detections=5))
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
