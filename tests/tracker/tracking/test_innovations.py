import numpy as np
import pytest

from tracker import Config, Measurements, PersonTracker
from tracker.tracking.innovations import Innovations, innovations_of

PERIOD_NS = 100_000_000
PLAIN = Config(motion="cv", association="hungarian", outlier_dof=0.0)


def watched(frames, config=PLAIN):
    rounds = []
    tracker = PersonTracker(config, watch=rounds.append)
    tracks = [tracker.step(number * PERIOD_NS, claims) for number, claims in enumerate(frames)]
    return rounds, tracks


def hand(bearing_rad, range_m):
    return Measurements.polar([bearing_rad], [range_m], 0.05, 0.08)


def test_the_innovation_is_what_filterpy_s_filter_makes_of_the_same_numbers():
    filterpy = pytest.importorskip("filterpy.kalman")
    rng = np.random.default_rng(3)
    xy = rng.normal((2.0, 1.0), 0.1, (20, 2))
    noise = 0.1**2 * np.eye(2)
    rounds, _ = watched([Measurements.cartesian(point[None], noise) for point in xy])
    raised = [item for item in rounds if len(item.claims)]
    found = Innovations.concatenate([innovations_of(item) for item in raised[1:]])

    oracle = filterpy.KalmanFilter(dim_x=4, dim_z=2)
    oracle.H, oracle.R = np.eye(2, 4), noise
    oracle.x = np.append(xy[0], [0.0, 0.0])
    oracle.P = np.diag([0.1**2, 0.1**2, *[PLAIN.initial_speed_std_mps**2] * 2])
    dt, q = 0.1, PLAIN.acceleration_density
    oracle.F = np.eye(4) + dt * np.eye(4, k=2)
    block = np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]])
    oracle.Q = q * np.kron(block, np.eye(2))
    for row, point in enumerate(xy[1:]):
        oracle.predict()
        oracle.update(point)
        assert found.innovation[row] == pytest.approx(oracle.y, abs=1e-9)
        assert found.covariance[row] == pytest.approx(oracle.S, abs=1e-9)
        assert found.log_likelihood[row] == pytest.approx(oracle.log_likelihood, abs=1e-6)
        assert found.nis[row] == pytest.approx(oracle.mahalanobis**2, abs=1e-6)


def test_a_bearing_alone_has_one_number():
    rounds, _ = watched([hand(0.0, 2.0), hand(0.02, 2.0), hand(0.04, np.nan)])
    (last,) = [item for item in rounds if item.stamp_ns == 2 * PERIOD_NS and len(item.chosen)]
    found = innovations_of(last)
    assert found.ranged.tolist() == [False]
    assert found.raised.tolist() == [True]
    assert found.innovation[0, 1] == 0.0
    expected = found.innovation[0, 0] ** 2 / found.covariance[0, 0, 0]
    assert found.nis[0] == pytest.approx(expected)


def test_rounds_in_which_nobody_or_nothing_is_there_are_told_as_well():
    rounds, _ = watched([hand(0.0, 2.0), Measurements.none()])
    assert [len(item.claims) for item in rounds] == [1, 0, 0, 0]
    assert [len(item.existence) for item in rounds] == [0, 0, 1, 1]
    assert all(len(item.pairs) == len(item.chosen) == 0 for item in rounds)


def test_identities_are_those_of_the_tracks():
    rounds, tracks = watched([hand(0.0, 2.0)] * 3)
    assert innovations_of(rounds[-2]).id.tolist() == tracks[-1].id.tolist() == [1]


def test_watching_changes_no_track():
    rng = np.random.default_rng(4)
    frames = [hand(0.1 * rng.normal(), 3.0 + 0.1 * rng.normal()) for _ in range(30)]
    _, seen = watched(frames, Config())
    tracker = PersonTracker(Config(), compiled=False)
    for number, (claims, expected) in enumerate(zip(frames, seen, strict=True)):
        tracks = tracker.step(number * PERIOD_NS, claims)
        np.testing.assert_array_equal(tracks.mean, expected.mean)
        np.testing.assert_array_equal(tracks.existence, expected.existence)
