import numpy as np
import pytest

from benchmarks._verdict_fit import fit_weights
from tracker.perception.verdict.weights import NAMES, WEIGHTS


def rows(count, rng, **of_calls):
    """Evidence that tells calls by some quantities, and whether each row is one."""
    calls = rng.random(count) < 0.5
    evidence = np.zeros((count, len(NAMES)))
    for name, (there, otherwise) in of_calls.items():
        evidence[:, NAMES.index(name)] = np.where(calls, there, otherwise)
    return evidence, calls


def test_without_data_the_priors_stand():
    bias, weights = fit_weights(
        np.zeros((2, len(NAMES))), np.array([True, False]), np.full(2, 1e-9)
    )
    assert bias == pytest.approx(0.0, abs=0.1)
    assert weights == pytest.approx({name: WEIGHTS[name].prior for name in NAMES}, abs=1e-3)


def test_what_tells_calls_gains_weight():
    evidence, calls = rows(400, np.random.default_rng(1), high=(0.6, 0.1))
    _, weights = fit_weights(evidence, calls, np.ones(400))
    assert weights["high"] > WEIGHTS["high"].prior
    assert weights["head"] == pytest.approx(WEIGHTS["head"].prior)


def test_no_weight_contradicts_its_meaning():
    evidence, calls = rows(400, np.random.default_rng(2), head=(0.9, 0.0), high=(0.0, 0.9))
    _, weights = fit_weights(evidence, calls, np.ones(400))
    assert weights["head"] == weights["high"] == 0.0


def test_the_best_weights_have_no_slope():
    rng = np.random.default_rng(3)
    evidence, calls = rows(200, rng, found=(1.0, 0.4), forearm=(0.9, 0.5))
    evidence += 0.1 * rng.normal(size=evidence.shape)
    share = rng.uniform(0.5, 1.5, 200)
    bias, weights = fit_weights(evidence, calls, share)
    values = np.array([weights[name] for name in NAMES])
    odds = bias + evidence @ values
    slope = share @ (1.0 / (1.0 + np.exp(-odds)) - calls)
    assert slope == pytest.approx(0.0, abs=0.01)
