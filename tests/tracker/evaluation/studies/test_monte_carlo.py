import dataclasses
import json
import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from tracker.errors import ConfigError, SceneError
from tracker.evaluation.studies.monte_carlo import monte_carlo, run_unit
from tracker.evaluation.studies.study import study_as_dict
from tracker.evaluation.trials.scenario import SCENARIOS, default_config

SHORT = dataclasses.replace(SCENARIOS["people"], duration_s=3.0)


def test_the_same_seed_is_the_same_study_whoever_runs_it():
    here = monte_carlo(SHORT, 5, seed=2)
    with ThreadPoolExecutor(2) as executor:
        there = monte_carlo(SHORT, 5, seed=2, executor=executor)
    for name, values in here.rows.items():
        assert np.array_equal(values, there.rows[name], equal_nan=True), name


def test_more_trials_begin_with_the_same_ones():
    few, many = monte_carlo(SHORT, 2, seed=2), monte_carlo(SHORT, 4, seed=2)
    for name, values in few.rows.items():
        assert np.array_equal(values, many.rows[name][:2], equal_nan=True), name


def test_seeds_differ():
    one, other = monte_carlo(SHORT, 1, seed=1), monte_carlo(SHORT, 1, seed=2)
    assert one.rows["gospa_m"][0] != other.rows["gospa_m"][0]


def test_a_unit_is_a_piece_of_the_study():
    config = default_config(SHORT)
    piece = run_unit(SHORT, config, 2, 3, 1).rows
    whole = monte_carlo(SHORT, 4, seed=2).rows
    assert all(np.array_equal(piece[name], whole[name][3:], equal_nan=True) for name in whole)


@pytest.mark.parametrize("name", sorted(SCENARIOS))
def test_every_scenario_runs_and_can_be_told_in_json(name):
    scenario = SCENARIOS[name]
    if hasattr(scenario, "duration_s"):
        scenario = dataclasses.replace(scenario, duration_s=4.0)
    shares = []
    study = monte_carlo(scenario, 2, progress=shares.append)
    told = json.loads(json.dumps(study_as_dict(study), allow_nan=False))
    assert told["trials"] == 2
    assert all(np.isfinite(figure["value"]) for figure in told["figures"][:2])
    assert shares[-1] == 1.0


@pytest.mark.parametrize("name", sorted(SCENARIOS))
def test_scenarios_can_be_sent_to_other_processes(name):
    assert pickle.loads(pickle.dumps(SCENARIOS[name])) == SCENARIOS[name]


def test_an_unknown_scenario_names_those_there_are():
    with pytest.raises(SceneError, match=r"moonbase.*model-matched"):
        monte_carlo("moonbase", 1)


@pytest.mark.parametrize(("trials", "seed"), [(0, 1), (1, -1)])
def test_no_trials_and_negative_seeds_are_refused(trials, seed):
    with pytest.raises(ConfigError, match=f"{trials} trials of seed {seed}"):
        monte_carlo("model-matched", trials, seed)


def test_a_study_of_the_whole_tracker_tells_how_many_people_its_ellipses_hold():
    study = monte_carlo(SHORT, 6, seed=2)
    (covered,) = [figure for figure in study.figures if "95 % ellipse" in figure.name]
    assert covered.value == pytest.approx(study.rows["covered_share"].mean())
    assert 0.9 < covered.low < covered.value < covered.high
