from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from tracker.errors import SceneError
from tracker.evaluation.detection.scenes import (
    FACTORS,
    HAND_UP_S,
    Conditions,
    caller_scene,
    draw_conditions,
    idlers_scene,
    is_in_view,
)
from tracker.simulation.motion import people_at

SOME = Conditions(2.0, "dark", "moving", "brown", "long", "left", "together")


def test_every_level_comes_equally_often_at_each_distance():
    drawn = draw_conditions([1.0, 4.0], 61, np.random.default_rng(3))
    assert Counter(item.distance_m for item in drawn) == {1.0: 31, 4.0: 30}
    for distance_m in (1.0, 4.0):
        for name, levels in FACTORS.items():
            counts = Counter(
                getattr(item, name) for item in drawn if item.distance_m == distance_m
            )
            assert set(counts) == set(levels)
            assert max(counts.values()) - min(counts.values()) <= 1


def test_factors_are_dealt_independently_of_each_other():
    drawn = draw_conditions([2.0], 3000, np.random.default_rng(4))
    pairs = Counter((item.hand, item.company) for item in drawn)
    # Hypergeometric: 750 expected, standard deviation 13.7; four of them.
    assert all(abs(count - 750) < 55 for count in pairs.values())


@pytest.mark.parametrize("distance_m", [0.8, 1.0, 5.0])
def test_a_caller_s_whole_hand_is_in_view_when_it_goes_up(distance_m):
    rng = np.random.default_rng(5)
    for _ in range(20):
        conditions = Conditions(distance_m, "normal", "sharp", "tan", "bare", "right", "alone")
        scene = caller_scene(conditions, 3.0, 10.0, rng)
        assert is_in_view(scene, HAND_UP_S)
        assert scene.people[0].path[0].x_m == distance_m
        assert not people_at(scene, HAND_UP_S - 1e-6).hand_up[0]
        assert people_at(scene, HAND_UP_S).hand_up[0]


def test_a_scene_shows_what_its_conditions_say():
    scene = caller_scene(SOME, 3.0, 10.0, np.random.default_rng(6))
    caller, idler = scene.people
    assert (caller.hand, caller.look.sleeve, caller.look.skin) == ("left", "long", "#8a5a3b")
    assert (scene.camera.exposure, scene.camera.motion_px) == (0.35, 3)
    assert idler.path[0].x_m > caller.path[0].x_m
    assert not idler.raises


@pytest.mark.parametrize("sign", ["fist", "finger"])
def test_a_closed_hand_that_calls_is_well_up(sign):
    rng = np.random.default_rng(11)
    callers = [caller_scene(replace(SOME, sign=sign), 3.0, 10.0, rng).people[0] for _ in range(8)]
    assert {caller.sign for caller in callers} == {sign}
    assert {caller.raise_style for caller in callers} == {"beside", "straight"}


def test_a_wave_goes_to_and_fro_while_the_hand_is_up():
    scene = caller_scene(replace(SOME, sign="wave"), 3.0, 10.0, np.random.default_rng(12))
    swing = [people_at(scene, HAND_UP_S + tick / 20.0).swing[0] for tick in range(40)]
    assert scene.people[0].sign == "palm"
    assert min(swing) < -0.9
    assert max(swing) > 0.9
    assert people_at(scene, HAND_UP_S - 0.1).swing[0] == 0.0


def test_the_same_generator_draws_the_same_scene():
    one, same = (caller_scene(SOME, 3.0, 10.0, np.random.default_rng(7)) for _ in range(2))
    assert one == same
    assert caller_scene(SOME, 3.0, 10.0, np.random.default_rng(8)) != one


def test_a_hand_too_near_for_the_picture_is_refused():
    near = Conditions(0.2, "normal", "sharp", "tan", "bare", "right", "alone")
    with pytest.raises(SceneError, match=r"At 0\.2 m no raised hand fits"):
        caller_scene(near, 3.0, 10.0, np.random.default_rng(9))


def test_idlers_never_call_and_take_turns_in_what_they_do():
    rng = np.random.default_rng(10)
    scenes = [idlers_scene(number, 60.0, (1.0, 5.0), 10.0, rng) for number in range(8)]
    people = [person for scene in scenes for person in scene.people]
    assert not any(person.raises for person in people)
    counts = Counter(person.activities[0].what for person in people)
    assert set(counts.values()) == {4}
    assert all(1.0 <= person.path[0].x_m <= 5.0 for person in people)
