import dataclasses

import numpy as np
import pytest
from scipy.stats import binom, chi2, norm

from tracker.evaluation.trials.people_scene import draw_scene
from tracker.evaluation.trials.people_sensing import sense
from tracker.evaluation.trials.scenario import PeopleScenario

PLAIN = PeopleScenario(
    title="Nothing goes wrong.",
    duration_s=60.0,
    people=(1, 1),
    detection_probability=1.0,
    clutter_per_frame=0.0,
    body_width_m=0.0,
)


def measured(scenario, seed=1):
    rng = np.random.default_rng(seed)
    scene = draw_scene(scenario, rng)
    return scene.truth, [sensed.measurements for sensed in sense(scenario, scene, rng)]


def errors(truth, frames):
    """Measured minus true bearing and range of a single person, shape (T, 2)."""
    values = np.array([item.values[0] for item in frames])
    xy = truth.xy_m[:, 0]
    polar = np.stack([np.arctan2(xy[:, 1], xy[:, 0]), np.linalg.norm(xy, axis=-1)], axis=-1)
    return values - polar


def test_noise_is_as_large_as_stated():
    truth, frames = measured(PLAIN)
    error = errors(truth, frames)
    covariance = np.array([item.covariance[0] for item in frames])
    normalized = (error**2 / covariance[:, [0, 1], [0, 1]]).sum()
    low, high = chi2.ppf([0.0005, 0.9995], error.size)
    assert low <= normalized <= high


@pytest.mark.parametrize("share", [0.95, 0.6])
def test_people_are_missed_as_often_as_stated(share):
    _, frames = measured(dataclasses.replace(PLAIN, detection_probability=share))
    low, high = binom.ppf([0.0005, 0.9995], len(frames), share)
    assert low <= sum(len(item) for item in frames) <= high


def test_outliers_are_as_frequent_as_stated():
    truth, frames = measured(dataclasses.replace(PLAIN, outlier_share=0.2, outlier_m=1000.0))
    off = errors(truth, frames)[:, 1] > 1.0
    low, high = binom.ppf([0.0005, 0.9995], len(frames), 0.2)
    assert low <= off.sum() <= high


def test_clutter_is_as_frequent_as_stated():
    _, frames = measured(dataclasses.replace(PLAIN, clutter_per_frame=2.0))
    count = sum(len(item) - 1 for item in frames)
    mean = 2.0 * len(frames)
    assert abs(count - mean) <= norm.ppf(0.9995) * np.sqrt(mean)


def test_latency_shows_where_people_were():
    late = dataclasses.replace(
        PLAIN, latency_s=0.4, pause_s=0.0, bearing_std_deg=0.001, range_std_m=1e-4
    )
    truth, frames = measured(late)
    ranges = np.array([item.values[0, 1] for item in frames])
    before = np.linalg.norm(truth.xy_m[:-4, 0], axis=-1)
    np.testing.assert_allclose(ranges[4:], before, atol=1e-3)


def test_a_turned_robot_still_points_at_people():
    turning = dataclasses.replace(PLAIN, turn_amplitude_deg=60.0, bearing_std_deg=0.001)
    truth, frames = measured(turning)
    pointed = np.array([item.values[0, 0] + item.sensor_pose[0, 2] for item in frames])
    xy = truth.xy_m[:, 0]
    np.testing.assert_allclose(pointed, np.arctan2(xy[:, 1], xy[:, 0]), atol=1e-3)


def test_who_stands_behind_somebody_is_mostly_hidden():
    narrow = dataclasses.replace(
        PLAIN, people=(2, 2), area_m=(1.0, 7.0, -0.01, 0.01), body_width_m=0.4
    )
    _, frames = measured(narrow)
    assert sum(len(item) for item in frames) < 1.3 * len(frames)


def test_lowered_hands_come_from_the_scan_alone():
    down = dataclasses.replace(
        PLAIN,
        hand_up_s=(2.0, 2.0),
        hand_down_s=(8.0, 8.0),
        scan_detection_probability=1.0,
    )
    truth, frames = measured(down)
    for frame, item in enumerate(frames):
        assert item.raised.sum() == truth.hand_up[frame].sum()
        assert (~item.raised).sum() == 1
