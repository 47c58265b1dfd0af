import numpy as np
import pytest

from tracker import Config, Measurements
from tracker.tracking.prediction.motion import predict
from tracker.tracking.settings import settings_of
from tracker.tracking.update.outliers import outlier_variance

MEAN = np.array([[3.0, 0.5, 0.2, 0.0]])
COVARIANCE = np.diag([0.02, 0.03, 0.2, 0.2])[None]


def test_with_many_degrees_of_freedom_it_is_the_gaussian_update(corrected):
    claims = Measurements.polar(0.17, 3.1, 0.03, 0.1)
    plain = corrected(MEAN, COVARIANCE, claims)
    tailed = corrected(MEAN, COVARIANCE, claims, 1e9)
    np.testing.assert_allclose(tailed[0], plain[0], atol=1e-6)
    np.testing.assert_allclose(tailed[1], plain[1], atol=1e-6)


def test_a_range_from_the_wall_behind_hardly_moves_anybody(corrected):
    claims = Measurements.polar(np.arctan2(0.5, 3.0), 6.0, 0.03, 0.1)
    plain, _ = corrected(MEAN, COVARIANCE, claims)
    tailed, spread = corrected(MEAN, COVARIANCE, claims, 4.0)
    assert plain[0, 0] > 4.0
    assert tailed[0, 0] == pytest.approx(3.0, abs=0.1)
    # ... and is known to have told next to nothing about the range.
    assert spread[0, 0, 0] > 0.8 * COVARIANCE[0, 0, 0]


@pytest.mark.parametrize(
    "claims",
    [Measurements.bearings(0.3, 0.03), Measurements.cartesian([9.0, 9.0], 0.01 * np.eye(2))],
    ids=["bearing", "position"],
)
def test_what_has_no_range_is_not_doubted(corrected, claims):
    np.testing.assert_array_equal(
        corrected(MEAN, COVARIANCE, claims, 4.0)[0], corrected(MEAN, COVARIANCE, claims)[0]
    )


def test_the_weight_of_a_range_is_a_fixed_point_of_the_variational_rounds():
    dof, a, r, y = 4.0, 0.02, 0.01, 0.5
    variance = outlier_variance((0.0, y), (1.0, 0.0, a), (0.1, 0.0, r), dof)
    weight = r / variance
    # E[(z - h(x))^2] under the posterior by a noise of R / w.
    stays = variance / (a + variance)
    expected = (dof + 1.0) / (dof + ((stays * y) ** 2 + a * stays) / r)
    assert weight < 0.5
    assert weight == pytest.approx(expected, rel=0.1)  # after four rounds


def test_no_range_is_more_certain_than_it_says():
    for y in (0.0, 0.05, 0.1):
        assert outlier_variance((0.0, y), (1.0, 0.0, 0.02), (0.1, 0.0, 0.01), 4.0) >= 0.01


def test_five_percent_of_outliers_lose_nobody(people_of, corrected):
    rng = np.random.default_rng(3)
    trials, errors = 60, {0.0: [], 4.0: []}
    walking = settings_of(Config(motion="cv", acceleration_density=0.01))
    for dof, kept in errors.items():
        people = people_of(np.repeat(MEAN, trials, 0), COVARIANCE)
        truth = MEAN + rng.normal(size=(trials, 4)) * np.sqrt(COVARIANCE[0].diagonal())
        for _ in range(60):
            truth = truth + 0.1 * np.pad(truth[:, 2:], ((0, 0), (0, 2)))
            predict(people, 0.1, walking, people)
            range_m = np.hypot(truth[:, 0], truth[:, 1]) + rng.normal(scale=0.08, size=trials)
            range_m += np.where(rng.random(trials) < 0.05, rng.normal(scale=2.0, size=trials), 0)
            bearing = np.arctan2(truth[:, 1], truth[:, 0]) + rng.normal(scale=0.03, size=trials)
            claims = Measurements.polar(bearing, np.maximum(range_m, 0.01), 0.03, 0.08)
            people.mean[0], people.covariance[0] = corrected(
                people.mean[0], people.covariance[0], claims, dof
            )
            kept.append(np.hypot(*(people.mean[0] - truth)[:, :2].T))
    assert np.max(errors[4.0]) < 1.0
    assert np.mean(errors[4.0]) < 0.6 * np.mean(errors[0.0])
