import numpy as np

from tracker.simulation.motion import people_at
from tracker.simulation.random_rooms.guests import Visit
from tracker.simulation.random_rooms.restaurant import draw_restaurant


def draw(seed, **changes):
    wanted = {
        "people": 4,
        "duration_s": 30.0,
        "rate_hz": 10.0,
        "sitting_share": 0.5,
        "pause_s": 5.0,
        "hand_up_s": (2.0, 4.0),
        "hand_down_s": (5.0, 10.0),
        **changes,
    }
    return draw_restaurant(np.random.default_rng(seed), Visit(**wanted))


def test_the_same_randomness_is_the_same_restaurant():
    assert draw(1) == draw(1)
    assert draw(1) != draw(2)


def test_who_sits_stays_and_who_walks_moves():
    sitting, walking = draw(1, sitting_share=1.0), draw(1, sitting_share=0.0)
    assert all(person.seat_m is not None and len(person.path) == 1 for person in sitting.people)
    assert all(person.seat_m is None and len(person.path) > 1 for person in walking.people)


def test_hands_go_up_and_down_for_the_times_wanted():
    for person in draw(3).people:
        for one in person.raises:
            assert 2.0 <= one.until_s - one.from_s <= 4.0
        for before, after in zip(person.raises, person.raises[1:], strict=False):
            assert 5.0 <= after.from_s - before.until_s <= 10.0


def test_people_keep_apart_nearly_always():
    near = []
    for seed in range(5):
        scene = draw(seed)
        for time_s in np.arange(0.0, 30.0, 0.5):
            xy = people_at(scene, time_s).xy_m
            distance = np.linalg.norm(xy[:, None] - xy, axis=-1)[np.triu_indices(4, 1)]
            near.append(distance.min() < 0.5)
    assert np.mean(near) < 0.05
