"""Which weights tell calls from the rest? Logistic regression around what is known beforehand."""

from __future__ import annotations

from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize

from tracker.containers import BoolArray, FloatArray
from tracker.perception.verdict.evidence import NAMES


class Prior(NamedTuple):
    """What is supposed of a weight before any data.

    Attributes:
        mean: Log-odds per unit, by what the quantity means.
        stiffness: How much it takes to move it there from; 1 is broad. Few people show fingers,
            swing their hand or stand far away, so that those weights should follow few data.
    """

    mean: float
    stiffness: float = 1.0


#: A weight keeps the sign of its prior; 0 may become anything.
PRIORS = MappingProxyType(
    {
        "found": Prior(0.0),
        "score": Prior(1.0, 10.0),
        "rise": Prior(2.0, 10.0),
        "lean": Prior(-1.0),
        "spread": Prior(0.4, 5.0),
        "thumb": Prior(-2.0),
        "owned": Prior(0.0),
        "unowned": Prior(-1.0),
        "alone": Prior(2.0),
        "low": Prior(-3.0),
        "palm_low": Prior(-2.0, 5.0),
        "high": Prior(3.0),
        "fist_low": Prior(-2.0),
        "overhead": Prior(2.0),
        "forearm": Prior(2.0),
        "head": Prior(-3.0),
        "palm_on_head": Prior(-3.0),
        "inside": Prior(-2.0),
        "together": Prior(-2.0, 10.0),
        "doubt": Prior(-0.5),
        "faint": Prior(-4.0),
        "apart": Prior(-1.0, 10.0),
        "swing": Prior(3.0, 10.0),
    }
)


def fit_weights(
    evidence: FloatArray, calls: BoolArray, share: FloatArray
) -> tuple[float, dict[str, float]]:
    """Bias and weights that explain best which hands call.

    The largest posterior of a logistic regression with normal priors:

        min  sum_i share_i (log(1 + exp(z_i)) - y_i z_i) + sum_f s_f (w_f - m_f)^2 / 2,
        z = b + X w

    Args:
        evidence: Shape (N, F), in the order of `NAMES`.
        calls: Shape (N,).
        share: Shape (N,): how much each row counts; images of one hand are alike.

    Returns:
        The bias, and the weight of each quantity.
    """
    mean = np.array([PRIORS[name].mean for name in NAMES])
    stiffness = np.array([PRIORS[name].stiffness for name in NAMES])

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
