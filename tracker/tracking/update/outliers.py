"""Is this range an outlier? Student-t noise, so that a range from the wall behind pulls little.

The noise of a range is Gaussian with a variance of its own, R / w, and w is Gamma distributed:
that is a Student-t. A few rounds of variational Bayes find w together with the position:

    w = (nu + 1) / (nu + E[(z - h(x))^2] / R),   where E is over the posterior under R / w.

Source: Piche, Sarkka and Hartikainen, "Recursive outlier-robust filtering and smoothing for
nonlinear systems using the multivariate Student-t distribution", IEEE MLSP 2012.
"""

from __future__ import annotations

from tracker.compiling.loops import loop

#: Rounds after which w changes by less than the noise of its own estimate.
ROUNDS = 4


@loop
def outlier_variance(
    innovation: tuple[float, float],
    own: tuple[float, float, float],
    noise: tuple[float, float, float],
    dof: float,
) -> float:
    """The range's variance, raised where the range fits badly.

    All is done in the two numbers of the measurement; the state is not touched, and the
    covariance of bearing and range is kept.

    Args:
        innovation: The second number is the range's.
        own: H P H' (00, 01, 11), what the track itself contributes to the innovation.
        noise: R (00, 01, 11).
        dof: Degrees of freedom nu; large ones make it Gaussian.
    """
    r00, r01, r11 = noise
    # Given the bearing, the range is one number y with prior variance a and noise r.
    share = (own[1] + r01) / (own[0] + r00)
    y = innovation[1] - share * innovation[0]
    r = r11 - r01 * r01 / r00
    a = max(own[2] + r11 - share * (own[1] + r01) - r, 0.0)
    weight = 1.0
    for _ in range(ROUNDS):
        scaled = r / weight
        posterior = scaled / (a + scaled)  # the share of the innovation that stays
        weight = (dof + 1.0) / (dof + (posterior * y * y * posterior + a * posterior) / r)
        weight = min(weight, 1.0)  # more certain than stated is no range
    return r11 + r * (1.0 / weight - 1.0)
