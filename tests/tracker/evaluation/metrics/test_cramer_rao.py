import numpy as np
import pytest

from tracker.evaluation.metrics.cramer_rao import polar_information, posterior_bound

PRIOR = np.diag([0.3, 0.3, 0.5, 0.5]) ** 2


def random_path(rng, frames=15):
    steps = rng.normal(scale=0.15, size=(frames, 2))
    return np.array([4.0, 1.0]) + np.cumsum(steps, axis=0)


def test_the_bound_equals_stone_soup_s(stonesoup, at):
    from stonesoup.metricgenerator.pcrbmetric import PCRBMetric
    from stonesoup.models.measurement.nonlinear import CartesianToBearingRange
    from stonesoup.models.transition.linear import (
        CombinedLinearGaussianTransitionModel,
        ConstantVelocity,
    )
    from stonesoup.types.groundtruth import GroundTruthPath, GroundTruthState
    from stonesoup.types.state import GaussianState

    order = [0, 2, 1, 3]  # Stone Soup's x, vx, y, vy from x, y, vx, vy
    bearing_std_rad, range_std_m, density, dt_s = np.deg2rad(2.0), 0.08, 0.3, 0.1
    rng = np.random.default_rng(7)
    for _ in range(3):
        path = random_path(rng)
        # The first state only carries the prior; nothing is measured there.
        states = [
            GroundTruthState([x, 0.0, y, 0.0], at(dt_s * frame))
            for frame, (x, y) in enumerate([path[0], *path])
        ]
        metric = PCRBMetric(
            prior=GaussianState(np.zeros(4), PRIOR[np.ix_(order, order)]),
            transition_model=CombinedLinearGaussianTransitionModel(
                [ConstantVelocity(density), ConstantVelocity(density)]
            ),
            measurement_model=CartesianToBearingRange(
                4, (0, 2), np.diag([bearing_std_rad**2, range_std_m**2])
            ),
            sensor_locations=np.zeros((2, 1, 1)),  # a column of StateVectors would lose its shape
            position_mapping=(0, 2),
        )
        expected = metric._compute_pcrb_single(
            metric.prior,
            metric.transition_model,
            metric.measurement_model,
            GroundTruthPath(states),
            metric.sensor_locations,
            1.0,
            (0, 2),
            None,
        )["inverse_j"][1:]
        information = polar_information(path, np.zeros(2), bearing_std_rad, range_std_m)
        found = posterior_bound(PRIOR, information, dt_s, density)
        np.testing.assert_allclose(found[:, order][:, :, order], expected, rtol=1e-5, atol=1e-9)


def test_many_paths_at_once_are_many_paths_one_by_one():
    rng = np.random.default_rng(8)
    paths = np.stack([random_path(rng) for _ in range(4)], axis=1)
    information = polar_information(paths, np.zeros(2), 0.05, 0.1)
    together = posterior_bound(PRIOR, information, 0.1, 0.3)
    for row in range(4):
        alone = posterior_bound(PRIOR, information[:, row], 0.1, 0.3)
        np.testing.assert_allclose(together[:, row], alone, rtol=1e-12)


def test_a_bearing_alone_tells_nothing_along_the_ray():
    information = polar_information(np.array([3.0, 0.0]), np.zeros(2), 0.1, np.inf)
    np.testing.assert_allclose(information, np.diag([0.0, 1.0 / 0.09]), atol=1e-12)


def test_for_a_linear_sensor_the_bound_is_the_kalman_filter_s_covariance():
    from filterpy.kalman import KalmanFilter

    from tracker.evaluation.metrics.constant_velocity import process_noise, transition

    kalman = KalmanFilter(4, 2)
    kalman.F, kalman.Q = transition(0.2), process_noise(0.2, 0.5)
    kalman.P, kalman.H = PRIOR.copy(), np.eye(2, 4)
    kalman.R = np.diag([0.04, 0.09])
    information = np.tile(np.linalg.inv(kalman.R), (12, 1, 1))
    bound = posterior_bound(PRIOR, information, 0.2, 0.5)
    for frame in range(12):
        kalman.predict()
        kalman.update(np.zeros(2))
        np.testing.assert_allclose(bound[frame], kalman.P, rtol=1e-9, atol=1e-12)
    assert bound[-1, 0, 0] == pytest.approx(kalman.P[0, 0])
