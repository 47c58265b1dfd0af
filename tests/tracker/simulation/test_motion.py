import numpy as np
import pytest

from tracker.simulation import scene_from_mapping
from tracker.simulation.motion import people_at, robot_pose


def test_people_walk_evenly_and_look_where_they_go(scene):
    people = people_at(scene, 0.5)
    np.testing.assert_allclose(people.xy_m[0], [2.0, 0.65])
    assert people.facing_rad[0] == pytest.approx(np.pi / 2)


def test_who_stands_faces_the_robot(scene):
    people = people_at(scene, 0.0)
    assert people.facing_rad[1] == pytest.approx(np.arctan2(0.2, -1.5))


def test_a_given_facing_turns_the_short_way_round(room):
    room["people"][0]["path"] = [
        {"at_s": 0.0, "x_m": 2.0, "y_m": 0.0, "facing_deg": 170.0},
        {"at_s": 2.0, "x_m": 2.0, "y_m": 0.0, "facing_deg": -170.0},
    ]
    people = people_at(scene_from_mapping(room), 1.0)
    assert np.cos(people.facing_rad[0]) == pytest.approx(-1.0)


@pytest.mark.parametrize(
    ("time_s", "raised", "is_up"),
    [
        (0.05, 0.0, False),
        (0.3, 0.5, False),
        (0.499999999, 0.999, False),
        (0.5, 1.0, True),
        (1.199999999, 1.0, True),
        (1.2, 0.999, False),
        (1.4, 0.5, False),
        (1.7, 0.0, False),
    ],
)
def test_the_hand_follows_the_scene_file(scene, time_s, raised, is_up):
    people = people_at(scene, time_s)
    assert people.raised[1] == pytest.approx(raised, abs=1e-3)
    assert bool(people.hand_up[1]) is is_up
    assert not people.hand_up[0]


def test_legs_stand_a_tenth_of_a_meter_to_both_sides(scene):
    legs = people_at(scene, 0.0).legs[0]
    np.testing.assert_allclose(legs[:, :2], [[1.9, 0.4], [2.1, 0.4]], atol=1e-12)
    np.testing.assert_allclose(legs[:, 2], 0.07)


def test_shins_of_who_sits_are_in_front_of_the_body(room):
    room["people"] = [
        {"id": 1, "seat_m": 0.45, "path": [{"x_m": 2.0, "y_m": 1.0, "facing_deg": 180.0}]}
    ]
    for given, forward_m in (({}, 0.1), ({"shins_m": 0.3}, 0.3)):
        room["people"][0].update(given)
        legs = people_at(scene_from_mapping(room), 0.0).legs[0, :, :2]
        np.testing.assert_allclose(legs.mean(axis=0), [2.0 - forward_m, 1.0])


def test_walking_legs_swing_against_each_other_along_the_way(scene):
    legs = people_at(scene, 0.65).legs[0]  # a quarter of a stride: 1.3 m / 4 at 0.5 m/s
    np.testing.assert_allclose(legs[:, 1].mean(), 0.725)
    np.testing.assert_allclose(legs[0, 1] - legs[1, 1], 0.4, atol=1e-9)


def test_the_robot_eases_through_the_middle_of_its_way(scene):
    np.testing.assert_allclose(robot_pose(scene, 1.0).planar, [0.2, 0.1, np.radians(15.0)])
    np.testing.assert_allclose(robot_pose(scene, 9.0).planar, [0.4, 0.2, np.radians(30.0)])
    slow = robot_pose(scene, 0.02).translation_m[0]
    assert slow < 0.02 * 0.4 / 2.0 * 0.1  # far behind an even drive
