"""Monte Carlo noise tests of the filter: bounds from chi-square, at 99.9 %, not from the code."""

import numpy as np
import pytest
from scipy.stats import chi2, norm

from tracker.config import Config
from tracker.containers import Measurements
from tracker.evaluation.metrics.consistency import normalized_squared
from tracker.evaluation.studies.monte_carlo import monte_carlo
from tracker.evaluation.trials import filter_study
from tracker.evaluation.trials.filter_study import (
    draw_filter_trials,
    filter_errors,
    prior_covariance,
    run_filter,
)
from tracker.evaluation.trials.scenario import SCENARIOS, default_config
from tracker.tracking.prediction.motion import carry, walk
from tracker.tracking.sensing.claims import claims_of
from tracker.tracking.update.correction import correct

TRIALS = 1000


def chi_square_bounds(dimensions, samples):
    return chi2.ppf([0.0005, 0.9995], dimensions * samples) / samples


@pytest.fixture(scope="module")
def studies():
    """One study of each filter scenario; the seed has nothing to do with any tuning."""
    names = ("model-matched-fine", "model-matched", "model-matched-coarse", "outliers")
    return {name: monte_carlo(name, TRIALS, seed=20_261) for name in names}


@pytest.mark.parametrize("name", ["model-matched-fine", "model-matched"])
def test_the_filter_is_as_wrong_as_it_says(studies, name):
    low, high = chi_square_bounds(4, TRIALS)
    assert low <= studies[name].rows["final_nees"].mean() <= high


@pytest.mark.parametrize("name", ["model-matched-fine", "model-matched", "model-matched-coarse"])
def test_no_filter_could_be_much_better(studies, name):
    rows = studies[name].rows
    excess = rows["mse_m2"] - 1.05**2 * rows["bound_m2"]
    margin = norm.ppf(0.999) * excess.std(ddof=1) / np.sqrt(TRIALS)
    assert excess.mean() <= margin
    # Nor can it be better than the bound allows, unless there is a mistake in either.
    gain = rows["bound_m2"] - rows["mse_m2"]
    assert gain.mean() <= norm.ppf(0.999) * gain.std(ddof=1) / np.sqrt(TRIALS)


def test_range_outliers_cost_little_and_lose_nobody(studies):
    rows = studies["outliers"].rows
    excess = rows["mse_m2"] - 1.2**2 * rows["bound_m2"]
    assert excess.mean() <= norm.ppf(0.999) * excess.std(ddof=1) / np.sqrt(TRIALS)
    assert studies["outliers"].lost == 0


def test_the_expected_information_bounds_below_what_the_paths_allow(studies):
    for study in studies.values():
        settled = study.bound_m2[10:].mean()
        assert settled <= study.rows["bound_m2"].mean() * (1 + 1e-9)


def test_a_linear_sensor_s_innovations_are_white_and_of_the_claimed_size():
    rng = np.random.default_rng(11)
    scenario, trials, noise = SCENARIOS["model-matched"], 200, np.diag([0.04, 0.02])
    drawn = draw_filter_trials(scenario, 11, 0, trials)
    mean = drawn.prior_mean[None].copy()
    covariance = np.repeat(prior_covariance(scenario)[None, None], trials, axis=1)
    motion, root = walk(0.1, scenario.acceleration_density), np.empty((4, 2))
    nis, white = [], []
    for truth in drawn.truth:
        xy = truth[:, :2] + rng.standard_normal((trials, 2)) @ np.sqrt(noise)
        claims = claims_of(Measurements.cartesian(xy, noise))
        for row in range(trials):
            carry(mean, covariance, 0, row, motion, mean, covariance)
        innovation, spread = xy - mean[0, :, :2], covariance[0, :, :2, :2] + noise
        nis.append(normalized_squared(innovation, spread))
        white.append(np.linalg.solve(np.linalg.cholesky(spread), innovation[..., None])[..., 0])
        for row in range(trials):
            correct(mean, covariance, 0, row, claims, row, 0.0, mean, covariance, row, root)
    low, high = chi_square_bounds(2, trials * scenario.frames)
    assert low <= np.mean(nis) <= high
    # Whitened innovations of neighboring frames: their products have mean 0 and variance 1.
    products = (np.array(white[1:]) * np.array(white[:-1])).ravel()
    assert abs(products.sum()) <= norm.ppf(0.9995) * np.sqrt(len(products))
    nees = normalized_squared(drawn.truth[-1] - mean[0], covariance[0])
    low, high = chi_square_bounds(4, trials)
    assert low <= nees.mean() <= high


def test_too_little_process_noise_is_found_out():
    scenario = SCENARIOS["model-matched"]
    config = default_config(scenario).replace(acceleration_density=0.03)
    _, high = chi_square_bounds(4, 300)
    assert monte_carlo(scenario, 300, 5, config).rows["final_nees"].mean() > high


def test_python_gives_what_machine_code_gives(monkeypatch):
    scenario, config = SCENARIOS["outliers"], Config()
    trials = draw_filter_trials(scenario, 3, 0, 10)
    fast = run_filter(scenario, config, trials)
    monkeypatch.setattr(filter_study, "machine_code", lambda function: function)
    for one, other in zip(run_filter(scenario, config, trials), fast, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-12)


def test_a_trial_does_not_depend_on_its_batch():
    scenario, config = SCENARIOS["outliers"], Config()
    together = filter_errors(scenario, config, seed=3, first=0, count=30)
    alone = filter_errors(scenario, config, seed=3, first=17, count=1)
    np.testing.assert_allclose(
        together.squared_error_m2[:, 17], alone.squared_error_m2[:, 0], rtol=1e-9
    )
    np.testing.assert_allclose(together.nees[:, 17], alone.nees[:, 0], rtol=1e-9)


def test_what_is_drawn_is_the_same_to_the_bit_in_every_batch():
    scenario = SCENARIOS["outliers"]
    together = draw_filter_trials(scenario, 3, 0, 30)
    alone = draw_filter_trials(scenario, 3, 17, 1)
    assert np.array_equal(together.truth[:, 17], alone.truth[:, 0])
    assert np.array_equal(together.range_m[:, 17], alone.range_m[:, 0])
