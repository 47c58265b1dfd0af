import numpy as np

from tracker.simulation.legs import chair_legs, table_posts
from tracker.simulation.motion import people_at
from tracker.simulation.random_rooms.bistro import draw_bistro
from tracker.simulation.random_rooms.guests import Visit


def draw(seed, **changes):
    wanted = {
        "people": 5,
        "duration_s": 30.0,
        "rate_hz": 10.0,
        "sitting_share": 0.5,
        "pause_s": 5.0,
        "hand_up_s": (2.0, 4.0),
        "hand_down_s": (5.0, 10.0),
        **changes,
    }
    return draw_bistro(np.random.default_rng(seed), Visit(**wanted))


def test_the_same_randomness_is_the_same_bistro():
    assert draw(1) == draw(1)
    assert draw(1) != draw(2)


def test_everybody_sits_on_a_chair_where_that_is_wanted():
    for seed in range(10):
        scene = draw(seed, sitting_share=1.0, people=6)
        chairs = {(chair.x_m, chair.y_m) for chair in scene.chairs}
        assert all(person.seat_m is not None for person in scene.people)
        assert {(person.path[0].x_m, person.path[0].y_m) for person in scene.people} <= chairs


def test_shins_are_in_front_of_who_sits_toward_the_table():
    for seed in range(5):
        scene = draw(seed, sitting_share=1.0)
        tables = np.array([(table.x_m, table.y_m) for table in scene.tables])
        people = people_at(scene, 0.0)
        shins = people.legs[..., :2].mean(axis=1)
        ahead_m = np.linalg.norm(shins - people.xy_m, axis=1)
        assert ((ahead_m >= 0.1) & (ahead_m <= 0.35)).all()
        near = [
            np.linalg.norm(tables - point, axis=1).min()
            for points in (shins, people.xy_m)
            for point in points
        ]
        assert (np.array(near[: len(shins)]) < np.array(near[len(shins) :])).all()


def test_no_leg_of_a_chair_or_of_a_sitting_guest_stands_in_a_table_s_post():
    for seed in range(10):
        scene = draw(seed, sitting_share=1.0)
        posts = np.array([post for table in scene.tables for post in table_posts(table)])
        legs = np.array([leg for chair in scene.chairs for leg in chair_legs(chair)])
        legs = np.concatenate([legs, people_at(scene, 0.0).legs.reshape(-1, 3)])
        apart_m = np.linalg.norm(legs[:, None, :2] - posts[:, :2], axis=-1)
        assert np.mean(apart_m < legs[:, None, 2] + posts[:, 2]) < 0.01


def test_some_stand_close_together_and_all_kinds_of_tables_occur():
    posts, near_m = set(), []
    for seed in range(10):
        scene = draw(seed, sitting_share=0.0)
        posts |= {table.posts for table in scene.tables}
        xy_m = people_at(scene, 10.0).xy_m
        near_m += list(np.linalg.norm(xy_m[1:] - xy_m[:-1], axis=1))
    assert posts == {1, 2, 4}
    assert 0.2 < np.mean(np.array(near_m) <= 0.61) < 0.6
