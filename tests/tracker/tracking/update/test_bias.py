"""What lasts of an error is in the covariance that is published, and nowhere else."""

import numpy as np
import pytest
from scipy.stats import chi2

from tracker import Config, Measurements, PersonTracker

pytestmark = pytest.mark.usefixtures("machine_code")

PLAIN = Config(motion="cv", association="hungarian", outlier_dof=0.0)
NOISE, OFFSET = 0.1**2 * np.eye(2), np.array([[0.04, 0.01], [0.01, 0.02]])


def follow(measurements, config=PLAIN):
    """The only customer's tracks, frame by frame."""
    tracker = PersonTracker(config, compiled=False)
    return [tracker.step(number * 10**8, each) for number, each in enumerate(measurements)]


def positions(xy_m, bias=None):
    return [Measurements.cartesian(each, NOISE, bias_covariance=bias) for each in xy_m]


def test_a_constant_bias_is_published_whole_and_moves_nobody():
    xy_m = np.random.default_rng(1).normal([2.0, 1.0], 0.1, (20, 2))
    for own, told in zip(follow(positions(xy_m)), follow(positions(xy_m, OFFSET)), strict=True):
        assert told.mean.tolist() == own.mean.tolist()
        excess = told.covariance[0] - own.covariance[0]
        assert excess[:2, :2] == pytest.approx(OFFSET)
        assert excess[2:].tolist() == np.zeros((2, 4)).tolist()


def test_schmidts_sensitivity_stays_where_a_track_begins():
    # S+ = (I - K H) S - K D with a bearing and a range, and the person's offset as bias.
    rng, at_m = np.random.default_rng(2), np.array([3.0, 1.0, 0.0, 0.0])
    covariance = np.diag([0.04, 0.04, 0.25, 0.25])
    sensitivity = np.vstack([np.eye(2), np.zeros((2, 2))])
    move = np.kron([[1.0, 0.1], [0.0, 1.0]], np.eye(2))
    for _ in range(20):
        at_m[:2] += rng.normal(0.0, 0.1, 2)
        covariance = move @ covariance @ move.T + 0.01 * np.eye(4)
        sensitivity = move @ sensitivity
        x, y = at_m[:2]
        slope = np.array([[-y, x], [x, y]]) / np.array([[x * x + y * y], [np.hypot(x, y)]])
        h = np.hstack([slope, np.zeros((2, 2))])
        gain = covariance @ h.T @ np.linalg.inv(h @ covariance @ h.T + np.diag([1e-3, 1e-2]))
        covariance = (np.eye(4) - gain @ h) @ covariance
        sensitivity = (np.eye(4) - gain @ h) @ sensitivity + gain @ slope
    assert sensitivity == pytest.approx(np.vstack([np.eye(2), np.zeros((2, 2))]), abs=1e-12)


def test_the_published_covariance_covers_people_whose_legs_are_off_all_the_time():
    rng, errors = np.random.default_rng(3), []
    config = PLAIN.replace(acceleration_density=0.01)
    for _ in range(150):
        off_m = rng.multivariate_normal(np.zeros(2), OFFSET)
        tracks = follow(positions(rng.normal(off_m, 0.1, (15, 2)), OFFSET), config)[-1]
        own = tracks.mean[0, :2]
        errors.append(own @ np.linalg.solve(tracks.covariance[0, :2, :2], own))
    assert 0.9 < np.mean(np.array(errors) < chi2.ppf(0.95, 2)) <= 1.0


def test_the_bias_of_another_kind_of_measurement_comes_in_as_it_takes_over():
    xy_m = np.zeros((30, 2))
    before, after = positions(xy_m[:5], OFFSET), positions(xy_m, np.zeros((2, 2)))
    without = follow(positions(np.zeros((35, 2))))
    share = [
        (told.covariance - own.covariance)[0, 0, 0] / OFFSET[0, 0]
        for told, own in zip(follow(before + after), without, strict=True)
    ]
    assert share[4] == pytest.approx(1.0)
    assert (np.diff(share[5:]) < 0.0).all()
    assert 0.0 < share[8] < 0.7
    assert share[-1] < 0.05


def test_nobody_is_less_certain_for_being_missed():
    told = follow(positions(np.zeros((5, 2)), OFFSET) + [Measurements.none()] * 5)
    own = follow(positions(np.zeros((5, 2))) + [Measurements.none()] * 5)
    assert (told[-1].covariance - own[-1].covariance)[0, :2, :2] == pytest.approx(OFFSET)
