import numpy as np
import pytest

from tracker import Config
from tracker.ranging import Background, PersonClusters, scan_people

PERIOD_NS = 100_000_000
AFTER_S = 2.0
CHAIR = (2.0, 0.5)


@pytest.fixture
def watch(cast):
    """Return a function that shows scans of circles to a background, and gives the next stamp."""

    def show(background, circles, scans, start=0, after_s=AFTER_S):
        for number in range(start, start + scans):
            scan = cast(circles, stamp_ns=number * PERIOD_NS)
            background.observe(scan, scan_people(scan, Config()), after_s)
        return start + scans

    return show


def holds(background, *points):
    return background.holds(np.array(points, float).reshape(-1, 2)).tolist()


def test_what_stands_still_for_long_is_background(watch):
    background = Background()
    number = watch(background, [(*CHAIR, 0.07)], 8)
    assert holds(background, CHAIR) == [False]
    watch(background, [(*CHAIR, 0.07)], 14, number)
    assert holds(background, CHAIR, (3.0, 0.0)) == [True, False]


def test_who_moves_is_not(watch):
    background = Background()
    for number in range(60):
        place = (2.0, -1.5 + 0.05 * number)
        watch(background, [(*place, 0.07)], 1, number)
        assert holds(background, place) == [False]


def test_a_place_is_free_again_once_the_scan_has_looked_through_it(watch):
    background = Background()
    number = watch(background, [(*CHAIR, 0.07)], 30)
    number = watch(background, [], 4, number)
    assert holds(background, CHAIR) == [True]  # four scans may be drop-outs
    watch(background, [], 1, number)
    assert holds(background, CHAIR) == [False]


def test_what_is_hidden_stays_background(watch):
    background = Background()
    number = watch(background, [(*CHAIR, 0.07)], 30)
    watch(background, [(1.0, 0.25, 0.2)], 50, number)
    assert holds(background, CHAIR) == [True]


def test_something_slim_that_stands_alone_and_still_is_background_sooner(watch):
    background, post, trousers = Background(), (1.5, 0.5, 0.03), (1.5, -0.5, 0.07)
    number = watch(background, [post, trousers], 20, after_s=30.0)
    assert holds(background, post[:2], trousers[:2]) == [False, False]
    number = watch(background, [post, trousers], 15, number, after_s=30.0)
    assert holds(background, post[:2], trousers[:2]) == [True, False]


def test_two_slim_legs_are_no_background_sooner(watch):
    background = Background()
    watch(background, [(1.5, 0.4, 0.03), (1.5, 0.6, 0.03)], 40, after_s=30.0)
    assert holds(background, (1.54, 0.5)) == [False]


def log_person(background, log_odds=-0.7, place=CHAIR):
    return float(background.log_person(np.array([place]), np.array([log_odds]))[0])


def test_what_does_not_move_is_less_and_less_likely_a_person(watch):
    background = Background()
    before = log_person(background)
    number = watch(background, [(*CHAIR, 0.07)], 100, after_s=300.0)
    after_ten_seconds = log_person(background)
    watch(background, [(*CHAIR, 0.07)], 200, number, after_s=300.0)
    assert log_person(background) < after_ten_seconds - 0.1 < before - 0.2


def test_a_place_remembers_what_it_looked_like(watch):
    background = Background()
    watch(background, [(1.5, 0.4, 0.05), (1.5, 0.6, 0.05)], 20)
    seen_as_two = log_person(background, place=(1.54, 0.5))
    assert seen_as_two > log_person(Background()) + 0.5


def test_a_customer_who_stands_still_never_becomes_background(watch):
    background = Background()
    for number in range(60):
        watch(background, [(*CHAIR, 0.07)], 1, number)
        background.spare(np.array([[2.1, 0.6]]), 0.45)
    assert holds(background, CHAIR) == [False]


def test_a_customer_beside_furniture_does_not_make_it_a_person_again(watch):
    background = Background()
    number = watch(background, [(*CHAIR, 0.07)], 30)
    background.spare(np.array([[2.1, 0.6]]), 0.45)
    watch(background, [(*CHAIR, 0.07)], 1, number)
    assert holds(background, CHAIR) == [True]


def test_a_raised_hand_frees_its_owner_s_place(watch):
    background = Background()
    watch(background, [(*CHAIR, 0.07)], 30)
    background.free(np.array([CHAIR]))
    assert holds(background, CHAIR) == [False]


def test_time_in_which_no_scan_came_does_not_count(watch):
    background = Background()
    watch(background, [(*CHAIR, 0.07)], 1, after_s=4.0)
    watch(background, [(*CHAIR, 0.07)], 1, 10_000, after_s=4.0)
    assert holds(background, CHAIR) == [False]


def test_after_reset_nothing_is_background(watch):
    background = Background()
    watch(background, [(*CHAIR, 0.07)], 30)
    background.reset()
    assert holds(background, CHAIR) == [False]


def test_memory_is_bounded(cast):
    background = Background()
    rng = np.random.default_rng(1)
    for _ in range(20):
        legs = np.full(200, 2)
        places = rng.uniform(-7.0, 7.0, (200, 2))
        people = PersonClusters(places, np.full(200, 0.3), legs, np.zeros(200))
        background.observe(cast([]), people, AFTER_S)
    assert len(background._places) <= 512
