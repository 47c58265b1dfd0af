import numpy as np
import pytest
from scipy.integrate import trapezoid

from tracker import Config, Measurements, PersonTracker
from tracker.evaluation.metrics.innovations import Innovations, innovations_of, log_densities
from tracker.evaluation.metrics.rounds import rounds_of

PERIOD_NS = 100_000_000
PLAIN = Config(motion="cv", association="hungarian", outlier_dof=0.0)


def watched(frames, config=PLAIN):
    rounds = []
    tracker = PersonTracker(config, watch=lambda frame: rounds.extend(rounds_of(frame)))
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
    found = Innovations.concatenate(*(innovations_of(item) for item in rounds[1:]))

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
    (last,) = [item for item in rounds if item.stamp_ns == 2 * PERIOD_NS]
    found = innovations_of(last)
    assert found.ranged.tolist() == [False]
    assert found.raised.tolist() == [True]
    assert found.innovation[0, 1] == 0.0
    expected = found.innovation[0, 0] ** 2 / found.covariance[0, 0, 0]
    assert found.nis[0] == pytest.approx(expected)


def test_identities_are_those_of_the_tracks():
    rounds, tracks = watched([hand(0.0, 2.0)] * 3)
    assert innovations_of(rounds[-1]).id.tolist() == tracks[-1].id.tolist() == [1]


def test_modes_of_motion_count_by_their_probability():
    rounds, _ = watched([hand(0.0, 2.0)] * 3, Config(motion="imm", outlier_dof=0.0))
    last = rounds[-1]
    each = np.exp(last.log_likelihood[0])
    assert log_densities(last) == pytest.approx([np.log(each @ last.weight[:, 0])])


def test_under_a_heavy_tail_densities_still_add_up_to_1():
    config = PLAIN.replace(outlier_dof=4.0, gate_probability=1.0 - 1e-12)

    def last_of(range_m):
        return watched([hand(0.0, 2.0), hand(0.0, 2.0), hand(0.0, range_m)], config)[0][-1]

    # At the bearing that was expected, over all ranges.
    ranges_m = np.linspace(0.02, 12.0, 600)
    density = [np.exp(log_densities(last_of(range_m))[0]) for range_m in ranges_m]
    bearing_variance = innovations_of(last_of(2.0)).covariance[0, 0, 0]
    of_bearing = 1.0 / np.sqrt(2.0 * np.pi * bearing_variance)
    assert trapezoid(density, ranges_m) == pytest.approx(of_bearing, rel=0.01)
