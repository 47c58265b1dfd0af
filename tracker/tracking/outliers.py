"""Is this range an outlier? Student-t noise, so that a range from the wall behind pulls little.

The noise of a range is Gaussian with a variance of its own, R / w, and w is Gamma distributed:
that is a Student-t. A few rounds of variational Bayes find w together with the position:

    w = (nu + 1) / (nu + E[(z - h(x))^2] / R),   where E is over the posterior under R / w.

Source: Piche, Sarkka and Hartikainen, "Recursive outlier-robust filtering and smoothing for
nonlinear systems using the multivariate Student-t distribution", IEEE MLSP 2012.
"""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray

#: Rounds after which w changes by less than the noise of its own estimate.
ROUNDS = 4


def outlier_noise(
    spread: FloatArray, innovation: FloatArray, noise: FloatArray, dof: float
) -> FloatArray:
    """Noise with the range's variance raised where the range fits badly.

    All is done in the two numbers of the measurement; the state is not touched.

    Args:
        spread: Shape (..., 2, 2): H P H', what the track itself contributes to the innovation.
        innovation: Shape (..., 2); the second is the range's.
        noise: Shape (..., 2, 2).
        dof: Degrees of freedom nu; large ones make it Gaussian.

    Returns:
        Noise of the same shape; the covariance of bearing and range is kept.
    """
    a00, a01, a11 = spread[..., 0, 0], spread[..., 0, 1], spread[..., 1, 1]
    r00, r01, r11 = noise[..., 0, 0], noise[..., 0, 1], noise[..., 1, 1]
    # Given the bearing, the range is one number y with prior variance a and noise r.
    share = (a01 + r01) / (a00 + r00)
    y = innovation[..., 1] - share * innovation[..., 0]
    r = r11 - r01 * r01 / r00
    a = np.maximum(a11 + r11 - share * (a01 + r01) - r, 0.0)
    weight = np.ones(y.shape)
    for _ in range(ROUNDS):
        scaled = r / weight
        posterior = scaled / (a + scaled)  # the share of the innovation that stays
        weight = (dof + 1.0) / (dof + (posterior * y * y * posterior + a * posterior) / r)
        weight = np.minimum(weight, 1.0)  # more certain than stated is no range
    raised = np.array(noise)
    raised[..., 1, 1] = r11 + r * (1.0 / weight - 1.0)
    return raised
