import dataclasses

import numpy as np
import pytest

from tracker.evaluation.metrics.frames import TrackFrames
from tracker.evaluation.recordings.tracker_steps import run_steps
from tracker.evaluation.trials import trial_loop
from tracker.evaluation.trials.people_scene import draw_scene
from tracker.evaluation.trials.people_sensing import sense
from tracker.evaluation.trials.people_trial import people_steps
from tracker.evaluation.trials.scenario import SCENARIOS, default_config
from tracker.evaluation.trials.trial_loop import track_sensed
from tracker.evaluation.trials.trial_seed import trial_rng


def short(name):
    return dataclasses.replace(SCENARIOS[name], duration_s=8.0)


def tracked(scenario, config):
    rng = trial_rng(5, 0)
    scene = draw_scene(scenario, rng)
    return track_sensed(scene.truth.stamps_ns, sense(scenario, scene, rng), config)


def check_same(one, other, **tolerance):
    for field in dataclasses.fields(TrackFrames):
        given, wanted = getattr(one, field.name), getattr(other, field.name)
        np.testing.assert_allclose(given, wanted, err_msg=field.name, **tolerance)


@pytest.mark.parametrize("name", ["people", "crowd", "hands-down", "rough"])
def test_a_trial_in_one_loop_is_the_tracker_frame_by_frame(name):
    scenario = short(name)
    config = default_config(scenario)
    frames = run_steps(people_steps(scenario, config, 5, 0), config)
    check_same(tracked(scenario, config), TrackFrames.of(list(frames)), rtol=0, atol=1e-9)


def test_python_gives_what_machine_code_gives(monkeypatch):
    scenario = dataclasses.replace(short("hands-down"), duration_s=3.0)
    config = default_config(scenario)
    fast = tracked(scenario, config)
    monkeypatch.setattr(trial_loop, "machine_code", lambda function: function)
    check_same(tracked(scenario, config), fast, rtol=0, atol=1e-9)


def test_there_is_room_for_more_people_than_expected(monkeypatch):
    scenario = dataclasses.replace(short("crowd"), duration_s=2.0)
    config = default_config(scenario)
    expected = tracked(scenario, config)
    monkeypatch.setattr(trial_loop, "PEOPLE_EXPECTED", 0)
    monkeypatch.setattr(trial_loop, "machine_code", lambda function: function)
    check_same(tracked(scenario, config), expected, rtol=0, atol=1e-9)
