import numpy as np
import pytest
from filterpy.common import Q_continuous_white_noise
from scipy.integrate import quad
from scipy.linalg import expm

from tracker import Config
from tracker.evaluation.metrics.constant_velocity import process_noise, transition
from tracker.tracking.prediction.motion import (
    carry,
    modes_of,
    predict,
    stand,
    switching,
    walk,
)
from tracker.tracking.settings import settings_of

MOTIONS = {
    "walk": lambda dt_s: walk(dt_s, 0.6),
    "stand": lambda dt_s: stand(dt_s, 0.1),
}
BOTH = pytest.mark.parametrize("motion", MOTIONS.values(), ids=MOTIONS)


def random_people(rng, *shape):
    root = rng.normal(size=(*shape, 4, 4))
    return rng.normal(size=(*shape, 4)), root @ np.swapaxes(root, -1, -2)


def carried(mean, covariance, motion):
    """Each of K modes and N people over an interval."""
    new_mean, new = np.empty_like(mean), np.empty_like(covariance)
    for mode, person in np.ndindex(mean.shape[:2]):
        carry(mean, covariance, mode, person, motion, new_mean, new)
    return new_mean, new


@pytest.mark.parametrize("dt_s", [0.01, 0.1, 1.0, 3.7])
@pytest.mark.parametrize("density", [0.05, 0.3, 4.0])
def test_process_noise_is_filterpy_s_continuous_white_noise(dt_s, density):
    oracle = Q_continuous_white_noise(
        dim=2, dt=dt_s, spectral_density=density, block_size=2, order_by_dim=False
    )
    np.testing.assert_allclose(process_noise(dt_s, density), oracle, rtol=1e-12)


@BOTH
@pytest.mark.parametrize("dt_s", [1e-4, 0.1, 2.0])
def test_two_half_steps_equal_a_whole_one(motion, dt_s):
    mean, covariance = random_people(np.random.default_rng(4), 2, 5)
    half = motion(dt_s / 2)
    found = carried(*carried(mean, covariance, half), half)
    for one, two in zip(carried(mean, covariance, motion(dt_s)), found, strict=True):
        np.testing.assert_allclose(two, one, rtol=1e-9)


@pytest.mark.parametrize("dt_s", [1e-4, 0.1, 2.0])
def test_people_change_over_by_the_interval_alone(dt_s):
    def chain(dt_s):
        stops, starts = switching(dt_s, 5.0, 8.0)
        return np.array([[1.0 - stops, stops], [starts, 1.0 - starts]])

    half = chain(dt_s / 2)
    np.testing.assert_allclose(half @ half, chain(dt_s), rtol=1e-12)


def test_no_time_changes_nothing():
    assert (transition(0.0) == np.eye(4)).all()
    assert (process_noise(0.0, 0.3) == 0.0).all()
    for motion in MOTIONS.values():
        assert motion(0.0) == (0.0, 1.0, 0.0, 0.0, 0.0)
    assert switching(0.0, 5.0, 8.0) == (0.0, 0.0)


@BOTH
def test_the_carried_covariance_is_that_of_the_matrices(matrices_of, motion):
    mean, covariance = random_people(np.random.default_rng(5), 2, 3)
    found = carried(mean, covariance, motion(0.3))
    step, noise = matrices_of(motion(0.3))
    for mode, row in np.ndindex(2, 3):
        expected = step @ covariance[mode, row] @ step.T + noise
        np.testing.assert_allclose(found[0][mode, row], step @ mean[mode, row], rtol=1e-12)
        np.testing.assert_allclose(found[1][mode, row], expected, rtol=1e-12, atol=1e-14)


@BOTH
def test_people_are_carried_in_their_own_place_as_into_another(motion):
    mean, covariance = random_people(np.random.default_rng(6), 2, 3)
    expected = carried(mean, covariance, motion(0.3))
    for mode, person in np.ndindex(2, 3):
        carry(mean, covariance, mode, person, motion(0.3), mean, covariance)
    np.testing.assert_array_equal(mean, expected[0])
    np.testing.assert_array_equal(covariance, expected[1])


@pytest.mark.parametrize("dt_s", [1e-5, 0.1, 3.0])
def test_who_stands_sways_as_an_ornstein_uhlenbeck_process(matrices_of, dt_s):
    # Of dv = -v / T dt + noise of density 2 std^2 / T: an impulse moves and fades over the rest.
    memory_s, std_mps = 0.5, 0.2
    generator = np.kron([[0.0, 1.0], [0.0, -1.0 / memory_s]], np.eye(2))

    def moved(s):
        return memory_s * (1.0 - np.exp(-s / memory_s))

    def left(s):
        return np.exp(-s / memory_s)

    def added(one, other):
        power = 2.0 * std_mps**2 / memory_s
        return power * quad(lambda s: one(s) * other(s), 0.0, dt_s, epsabs=0.0)[0]

    motion = stand(dt_s, std_mps)
    step, _ = matrices_of(motion)
    np.testing.assert_allclose(step, expm(generator * dt_s), rtol=1e-9, atol=1e-15)
    expected = added(moved, moved), added(moved, left), added(left, left)
    np.testing.assert_allclose(motion[2:], expected, rtol=1e-4)


def test_a_prediction_leaves_the_people_it_came_from_as_they_were(people_of):
    rng = np.random.default_rng(7)
    people, ahead = (people_of(*random_people(rng, 2, 3)) for _ in range(2))
    before = [each.copy() for each in people]
    predict(people, 0.5, settings_of(Config()), ahead)
    for now, then in zip(people, before, strict=True):
        np.testing.assert_array_equal(now, then)


def test_with_one_mode_a_prediction_is_the_kalman_filter_s(people_of):
    config = Config(motion="cv", acceleration_density=0.6)
    people = people_of(*random_people(np.random.default_rng(8), 1, 3))
    ahead = people_of(np.zeros((3, 4)), np.eye(4))
    predict(people, 0.4, settings_of(config), ahead)
    step, noise = transition(0.4), process_noise(0.4, 0.6)
    np.testing.assert_allclose(ahead.mean[0], people.mean[0] @ step.T, rtol=1e-12)
    expected = step @ people.covariance[0] @ step.T + noise
    np.testing.assert_allclose(ahead.covariance[0], expected, rtol=1e-12)
    assert (ahead.weight == 1.0).all()


def test_in_the_long_run_people_spend_their_time_as_long_as_they_stay_so(people_of):
    config = Config(walk_duration_s=2.0, stand_duration_s=6.0)
    people = people_of(*random_people(np.random.default_rng(9), 2, 3), [[1.0], [0.0]])
    ahead = people_of(*random_people(np.random.default_rng(9), 2, 3))
    predict(people, 1e4, settings_of(config), ahead)
    np.testing.assert_allclose(ahead.weight, [[0.25] * 3, [0.75] * 3], rtol=1e-9)


def test_there_are_as_many_modes_as_the_configuration_says():
    assert [modes_of(Config(motion=name)) for name in ("cv", "imm")] == [1, 2]


def test_who_stands_hardly_drifts():
    after_8_s = stand(8.0, 0.1)
    assert np.sqrt(after_8_s.position) < 0.3
    assert after_8_s.velocity == pytest.approx(0.01)
    assert after_8_s.position * after_8_s.velocity > after_8_s.mixed**2
    assert after_8_s.reach_s == pytest.approx(0.5, abs=1e-6)
