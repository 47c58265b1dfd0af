from dataclasses import replace

import numpy as np
import pytest

from tracker.evaluation.trials.scan_trial import play_scan_trial, scan_trial
from tracker.evaluation.trials.scenario import SCENARIOS, default_config

SCENARIO = replace(
    SCENARIOS["hands-down-scans"],
    duration_s=12.0,
    people=(2, 2),
    hand_down_s=(1.0, 2.0),
    clutter_per_frame=0.0,
)
CONFIG = default_config(SCENARIO)


def test_a_trial_is_the_same_whenever_it_is_run():
    assert scan_trial(SCENARIO, CONFIG, 3, 1) == pytest.approx(
        scan_trial(SCENARIO, CONFIG, 3, 1), nan_ok=True, abs=0.0
    )


def test_tracks_stand_where_people_raise_their_hands():
    near = []
    for truth, result in play_scan_trial(SCENARIO, CONFIG, 3, 0):
        raised = result.tracks[result.tracks.raised & result.tracks.confirmed]
        for place in raised.mean[:, :2]:
            near.append(np.linalg.norm(truth.xy_m - place, axis=-1).min() < 0.5)
    assert len(near) > 20
    assert np.mean(near) > 0.8


@pytest.mark.parametrize("name", ["hands-down-map", "bistro-scans", "seated-scans"])
def test_a_known_map_leaves_fewer_clusters_to_be_taken_for_people(name):
    scenario = replace(SCENARIOS[name], duration_s=2.0)
    counts = {}
    for use_map in (True, False):
        config = default_config(scenario).replace(use_map=use_map)
        played = play_scan_trial(scenario, config, 5, 0)
        counts[use_map] = sum(len(result.measurements) for _, result in played)
    assert counts[True] < 0.8 * counts[False]


def test_every_frame_has_a_scan_and_a_place():
    _, result = next(iter(play_scan_trial(SCENARIO, CONFIG, 3, 0)))
    assert result.scan is not None
    assert result.sensor_pose is not None
    assert result.notes == ()
