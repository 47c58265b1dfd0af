"""Several sensors, or several claims of one body, show one newcomer."""

import numpy as np
import pytest
from filterpy.kalman import KalmanFilter

from tracker import Config, Measurements

NOISE = 0.08**2 * np.eye(2)
CONFIG = Config(motion="cv", outlier_dof=0.0)


def seen_from(place_m, *sensors_m, **claimed):
    """Bearing and range of a place from each sensor."""
    parts = []
    for sensor_m in sensors_m:
        away = np.subtract(place_m, sensor_m)
        pose = (*sensor_m, 0.0)
        bearing, range_m = np.arctan2(away[1], away[0]), np.hypot(*away)
        parts.append(Measurements.polar(bearing, range_m, 0.02, 0.05, pose, **claimed))
    return Measurements.concatenate(*parts)


@pytest.mark.parametrize("raised", [True, False], ids=["hand", "scan"])
def test_who_is_shown_by_two_sensors_at_once_is_one_newcomer(tracker_of, raised):
    tracker = tracker_of(CONFIG)
    both = seen_from((2.0, 1.0), (0.0, 0.0), (4.0, 0.0), raised=raised)
    for number in range(3):
        tracker.step(number * 10**8, both)
        assert tracker.people.id.tolist() == [1 if raised else -1]


def test_two_newcomers_seen_by_two_sensors_are_two(tracker_of):
    sensors = (0.0, 0.0), (4.0, 0.0)
    measured = Measurements.concatenate(
        seen_from((2.0, 1.0), *sensors), seen_from((2.0, -2.0), *sensors)
    )
    assert tracker_of(CONFIG).step(0, measured).id.tolist() == [1, 2]


def test_what_the_second_sensor_says_is_the_kalman_filter_s_update(tracker_of):
    points = np.array([[2.0, 1.0], [2.1, 1.05]])
    measured = Measurements.cartesian(points, NOISE, person=3)
    tracks = tracker_of(CONFIG).step(0, measured)
    oracle = KalmanFilter(dim_x=4, dim_z=2)
    oracle.x = np.array([2.0, 1.0, 0.0, 0.0])
    oracle.P = np.diag([0.08**2, 0.08**2, *[CONFIG.initial_speed_std_mps**2] * 2])
    oracle.H, oracle.R = np.eye(2, 4), NOISE
    oracle.update(points[1])
    assert tracks.id.tolist() == [1]
    np.testing.assert_allclose(tracks.mean[0], oracle.x, atol=1e-12)
    np.testing.assert_allclose(tracks.covariance[0], oracle.P, atol=1e-12)


def test_claims_of_one_tag_are_one_newcomer_s(tracker_of):
    measured = Measurements.cartesian([[2.0, 1.0], [3.0, 1.0]], NOISE, identity=[5, 5])
    assert tracker_of(CONFIG).step(0, measured).id.tolist() == [1]
    measured = Measurements.cartesian([[2.0, 1.0], [3.0, 1.0]], NOISE, identity=[5, 6])
    assert tracker_of(CONFIG).step(0, measured).id.tolist() == [1, 2]


def test_a_body_whose_claims_disagree_keeps_one_identity(tracker_of):
    tracker = tracker_of()
    apart = Measurements.cartesian([[2.0, 0.6], [2.0, -0.6]], NOISE, person=[3, 3])
    for number in range(10):
        tracks = tracker.step(number * 10**8, apart)
    assert tracks.id.tolist() == [1]
    assert tracks.raised.tolist() == [True]
    assert np.abs(tracks.mean[0, 1]) < 0.7
