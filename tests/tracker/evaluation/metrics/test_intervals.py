import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.stats import binomtest, norm, poisson

from tracker.evaluation.metrics.intervals import poisson_interval, wilson_interval


@pytest.mark.parametrize(("count", "total"), [(0, 7), (1, 7), (98, 100), (50, 50), (450, 1000)])
def test_a_share_s_interval_is_scipy_s(count, total):
    expected = binomtest(count, total).proportion_ci(method="wilson")
    np.testing.assert_allclose(wilson_interval(count, total), expected, atol=1e-12)


def test_wilson_s_ends_are_where_the_score_test_just_accepts():
    for end in wilson_interval(13, 40):
        score = (13 / 40 - end) / np.sqrt(end * (1 - end) / 40)
        assert abs(score) == pytest.approx(norm.ppf(0.975))


@pytest.mark.parametrize(("count", "hours"), [(1, 1.0), (4, 0.5), (30, 12.0)])
def test_a_rate_s_ends_are_where_the_count_is_just_too_rare(count, hours):
    low, high = poisson_interval(count, hours)
    assert low * hours == pytest.approx(brentq(lambda m: poisson.sf(count - 1, m) - 0.025, 0, 99))
    assert high * hours == pytest.approx(brentq(lambda m: poisson.cdf(count, m) - 0.025, 0, 99))


def test_no_event_still_allows_three_point_seven_in_the_time():
    assert poisson_interval(0, 1.0) == (0.0, pytest.approx(-np.log(0.025)))


def test_without_trials_there_is_no_interval():
    assert np.isnan([*wilson_interval(0, 0), *poisson_interval(0, 0.0)]).all()


@pytest.mark.parametrize("total", [1, 3, 12, 77])
def test_an_interval_holds_its_share(total):
    for count in range(total + 1):
        low, high = wilson_interval(count, total)
        assert 0.0 <= low <= count / total <= high <= 1.0
