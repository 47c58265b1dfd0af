from dataclasses import replace

import numpy as np
from filterpy.kalman import ExtendedKalmanFilter
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import approx_fprime

from tracker import Measurements
from tracker.tracking.filter import innovations, update
from tracker.tracking.motion import predict
from tracker.tracking.sensor_model import expect_polar, pose_noise


def random_tracks(rng, *shape):
    mean = rng.uniform([-3, -3, -1, -1], [3, 3, 1, 1], size=(*shape, 4))
    root = rng.normal(scale=0.3, size=(*shape, 4, 4))
    return mean, root @ np.swapaxes(root, -1, -2) + 0.05 * np.eye(4)


def polar_of(state, pose):
    dx, dy = state[0] - pose[0], state[1] - pose[1]
    return np.array([np.arctan2(dy, dx) - pose[2], np.hypot(dx, dy)])


def slope_of(state, pose):
    dx, dy = state[0] - pose[0], state[1] - pose[1]
    square = dx**2 + dy**2
    root = np.sqrt(square)
    return np.array([[-dy / square, dx / square, 0, 0], [dx / root, dy / root, 0, 0]])


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_a_polar_update_is_filterpy_s_to_ten_digits(seed):
    rng = np.random.default_rng(seed)
    mean, covariance = random_tracks(rng, 1)
    turn = rng.uniform(-np.pi, np.pi)
    away = rng.uniform(0, 2 * np.pi)
    pose = np.array([mean[0, 0] + 4 * np.cos(away), mean[0, 1] + 4 * np.sin(away), turn])
    value = polar_of(mean[0], pose) + rng.normal(scale=[0.03, 0.1])
    found = update(mean, covariance, Measurements.polar(*value, 0.03, 0.1, pose))
    oracle = ExtendedKalmanFilter(dim_x=4, dim_z=2)
    oracle.x, oracle.P = mean[0].copy(), covariance[0].copy()
    oracle.R = np.diag([0.03**2, 0.1**2])
    oracle.update(value, lambda x: slope_of(x, pose), lambda x: polar_of(x, pose))
    np.testing.assert_allclose(found[0][0], oracle.x, atol=1e-10)
    np.testing.assert_allclose(found[1][0], oracle.P, atol=1e-10)


def test_leading_axes_are_trials_of_their_own():
    rng = np.random.default_rng(4)
    mean, covariance = random_tracks(rng, 3, 5)
    claims = Measurements.polar(rng.normal(size=5), rng.uniform(2, 5, 5), 0.05, 0.1, (4, 0, 3))
    ahead = predict(mean, covariance, 0.1, 0.3)
    found, pairs = update(*ahead, claims, 4.0), innovations(*ahead, claims)
    for trial in range(3):
        one = predict(mean[trial], covariance[trial], 0.1, 0.3)
        for part, expected in zip(found, update(*one, claims, 4.0), strict=True):
            np.testing.assert_allclose(part[trial], expected, atol=1e-12)
        for part, expected in zip(pairs, innovations(*one, claims), strict=True):
            np.testing.assert_allclose(part[trial], expected, atol=1e-12)


def test_the_noise_of_the_sensor_s_pose_is_its_first_order_propagation():
    rng = np.random.default_rng(5)
    root = rng.normal(scale=0.1, size=(3, 3))
    doubt = root @ root.T
    person, pose = np.array([2.0, 1.0, 0.0, 0.0]), np.array([-1.0, 0.5, 0.7])
    slope = np.array(
        [approx_fprime(pose, lambda p, i=i: polar_of(person, p)[i], 1e-7) for i in range(2)]
    )
    _, jacobian = expect_polar(person, pose)
    np.testing.assert_allclose(pose_noise(jacobian, doubt), slope @ doubt @ slope.T, atol=1e-6)


def test_an_uncertain_pose_makes_the_posterior_less_certain():
    mean, covariance = random_tracks(np.random.default_rng(6), 1)
    sure = Measurements.polar(0.3, 3.0, 0.02, 0.05)
    unsure = replace(sure, sensor_pose_covariance=np.diag([0.01, 0.01, 0.01])[None])
    gained = update(mean, covariance, unsure)[1] - update(mean, covariance, sure)[1]
    assert np.linalg.eigvalsh(gained)[0, -1] > 1e-3
    assert np.linalg.eigvalsh(gained)[0, 0] > -1e-9
