"""Which weights tell calls from the rest? Logistic regression around what is known beforehand."""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize

from tracker.containers import BoolArray, FloatArray
from tracker.perception.verdict.weights import NAMES, WEIGHTS


def fit_weights(
    evidence: FloatArray, calls: BoolArray, share: FloatArray
) -> tuple[float, dict[str, float]]:
    """Bias and weights that explain best which hands call.

    The largest posterior of a logistic regression around normal priors (see `weights`):

        min  sum_i share_i (log(1 + exp(z_i)) - y_i z_i) + sum_f s_f (w_f - m_f)^2 / 2,
        z = b + X w

    Args:
        evidence: Shape (N, F), in the order of `NAMES`.
        calls: Shape (N,).
        share: Shape (N,): how much each row counts; images of one hand are alike.
    """
    mean = np.array([row.prior for row in WEIGHTS.values()])
    stiffness = np.array([row.stiffness for row in WEIGHTS.values()])

    def cost(values: FloatArray) -> tuple[float, FloatArray]:
        odds = values[0] + evidence @ values[1:]
        loss = share @ (np.logaddexp(0.0, odds) - calls * odds)
        off = values[1:] - mean
        slope = share * (1.0 / (1.0 + np.exp(-odds)) - calls)
        gradient = np.append(slope.sum(), slope @ evidence + stiffness * off)
        return float(loss + stiffness @ off**2 / 2.0), gradient

    signs = [(0.0 if item > 0.0 else None, 0.0 if item < 0.0 else None) for item in mean]
    bounds = [(None, None), *signs]
    start = np.append(0.0, mean)
    found = minimize(cost, start, jac=True, method="L-BFGS-B", bounds=bounds)
    return float(found.x[0]), dict(zip(NAMES, found.x[1:].tolist(), strict=True))
