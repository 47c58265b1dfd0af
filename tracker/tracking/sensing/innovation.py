"""How far is a measurement from what was predicted, and how uncertain are both?

innovation y = z - h(x),    S = H P H' + R
"""

from __future__ import annotations

import numpy as np

from tracker.compiling.loops import step
from tracker.containers import FloatArray
from tracker.tracking.sensing.claims import Claims
from tracker.tracking.sensing.sensor_kinds import (
    BEARING,
    POSITION,
    RANGE,
    expect,
    jacobian,
    pose_doubt,
    wrapped,
)


@step
def innovation_of(
    kind: int, expected: tuple[float, float], claims: Claims, row: int
) -> tuple[float, float]:
    """y: measured minus expected, a bearing in [-pi, pi), a missing number 0."""
    first, second = 0.0, 0.0
    if kind == POSITION:
        first = claims.values[row, 0] - expected[0]
    elif kind != RANGE:
        first = wrapped(claims.values[row, 0] - expected[0])
    if kind != BEARING:
        second = claims.values[row, 1] - expected[1]
    return first, second


@step
def noise_of(kind: int, claims: Claims, row: int) -> tuple[float, float, float]:
    """R (00, 01, 11) of a claim; 1 for a missing number."""
    r00, r01, r11 = claims.noise[row, 0, 0], claims.noise[row, 0, 1], claims.noise[row, 1, 1]
    if kind == BEARING:
        r01, r11 = 0.0, 1.0
    if kind == RANGE:
        r00, r01 = 1.0, 0.0
    return r00, r01, r11


@step
def projected(
    covariance: FloatArray,
    mode: int,
    person: int,
    h: tuple[float, float, float, float],
) -> tuple[float, float, float]:
    """H P H' (00, 01, 11): what a track itself contributes to the innovation's covariance."""
    h00, h01, h10, h11 = h
    p00, p01 = covariance[mode, person, 0, 0], covariance[mode, person, 0, 1]
    p11 = covariance[mode, person, 1, 1]
    x0, y0 = h00 * p00 + h01 * p01, h00 * p01 + h01 * p11
    x1, y1 = h10 * p00 + h11 * p01, h10 * p01 + h11 * p11
    return x0 * h00 + y0 * h01, x0 * h10 + y0 * h11, x1 * h10 + y1 * h11


@step
def seen_from(
    kind: int,
    mean: FloatArray,
    covariance: FloatArray,
    mode: int,
    person: int,
    claims: Claims,
    row: int,
) -> tuple[
    tuple[float, float],
    tuple[float, float, float, float],
    tuple[float, float, float],
    tuple[float, float, float],
]:
    """What the sensor of a claim would see of somebody.

    Args:
        kind: Of the claim.
        mean: Shape (K, N, 4).
        covariance: Shape (K, N, 4, 4).
        mode: Row of the mode.
        person: Row of the person.
        claims: M claims.
        row: The claim's.

    Returns:
        h(x), H, H P H', and what the sensor's pose adds to R.
    """
    x, y = mean[mode, person, 0], mean[mode, person, 1]
    h = jacobian(kind, x, y, claims, row)
    own = projected(covariance, mode, person, h)
    doubt = pose_doubt(h[0], h[1], h[2], h[3], claims, row)
    return expect(kind, x, y, claims, row), h, own, doubt


@step
def squared_distance(
    y: tuple[float, float], s: tuple[float, float, float], dof: float
) -> tuple[float, float]:
    """The squared distance y' inv(S) y, and the determinant of S.

    The second number is taken given the first: the distance is a sum of two squares then, and the
    second square is where a Student-t's tail belongs, (nu + 1) log(1 + d^2 / nu).

    Args:
        y: The innovation.
        s: S (00, 01, 11).
        dof: Degrees of freedom nu of the second number; 0 is Gaussian.
    """
    share = s[1] / s[0]
    rest, s_rest = y[1] - share * y[0], s[2] - share * s[1]
    square = rest * rest / s_rest
    if dof > 0.0:
        square = (dof + 1.0) * np.log1p(square / dof)
    return y[0] * y[0] / s[0] + square, s[0] * s_rest
