"""Which measurements could belong to which tracks? The pairs worth a closer look, one by one.

Most pairs are far apart, so a box that holds the gate's ellipse sorts them out first; what is left
is a list of pairs, about as long as there are people, and everything after works on that list.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.stats import chi2

from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, IntArray, Measurements
from tracker.geometry import normalize_angle
from tracker.tracking.claim_groups import ClaimGroup, group_claims
from tracker.tracking.modes import Belief
from tracker.tracking.outliers import outlier_noise
from tracker.tracking.sensor_model import expect_cartesian, expect_polar, pose_noise

_LOG_TURN = float(np.log(2.0 * np.pi))


@dataclass(frozen=True, slots=True, eq=False)
class Pairs:
    """P pairs of a track and a measurement inside its gate, by track, then by measurement.

    Attributes:
        track: Shape (P,): row of the track.
        claim: Shape (P,): row of the measurement.
        innovation: Shape (K, P, 2), under each mode of motion.
        jacobian: Shape (K, P, 2, 2), by x and y.
        noise: Shape (K, P, 2, 2), raised where the range is an outlier.
        log_likelihood: Shape (K, P), of the measurement, were it the track's.
        log_newcomer: Shape (P,): log-density of such measurements from nobody known.
    """

    track: IntArray
    claim: IntArray
    innovation: FloatArray
    jacobian: FloatArray
    noise: FloatArray
    log_likelihood: FloatArray
    log_newcomer: FloatArray

    def __len__(self) -> int:
        return len(self.track)

    def __getitem__(self, rows: BoolArray | IntArray) -> Pairs:
        return Pairs(
            self.track[rows],
            self.claim[rows],
            self.innovation[:, rows],
            self.jacobian[:, rows],
            self.noise[:, rows],
            self.log_likelihood[:, rows],
            self.log_newcomer[rows],
        )

    @staticmethod
    def join(parts: list[Pairs], modes: int) -> Pairs:
        """One list of several, in order."""
        if len(parts) == 1:
            return parts[0]
        rows, none = np.zeros(0, dtype=np.int64), np.zeros((modes, 0))
        numbers, matrices = np.zeros((modes, 0, 2)), np.zeros((modes, 0, 2, 2))
        empty = Pairs(rows, rows, numbers, matrices, matrices, none, np.zeros(0))
        parts = [empty, *parts]
        joined = Pairs(
            np.concatenate([part.track for part in parts]),
            np.concatenate([part.claim for part in parts]),
            np.concatenate([part.innovation for part in parts], axis=1),
            np.concatenate([part.jacobian for part in parts], axis=1),
            np.concatenate([part.noise for part in parts], axis=1),
            np.concatenate([part.log_likelihood for part in parts], axis=1),
            np.concatenate([part.log_newcomer for part in parts]),
        )
        return joined[np.lexsort((joined.claim, joined.track))]


def find_pairs(belief: Belief, claims: Measurements, config: Config) -> Pairs:
    """Pairs whose squared distance y' inv(S) y does not exceed the gate's limit.

    The limit is the chi-square quantile of `gate_probability`, with one degree of freedom for a
    bearing alone and two otherwise; under `outlier_dof` ranges have a Student-t's distance. With
    two modes of motion, the one Gaussian with their moments decides.

    Args:
        belief: N tracks, predicted.
        claims: M usable measurements, of raised hands alone or of everything else.
        config: `gate_probability`, `innovation_floor_m`, `outlier_dof`, and the densities of
            what is nobody's.
    """
    density = density_of_nobody(claims, config)
    parts = [_pairs_of_group(belief, group, density, config) for group in group_claims(claims)]
    return Pairs.join(parts, len(belief.weight))


def density_of_nobody(claims: Measurements, config: Config) -> float:
    """How many such measurements of nobody known a frame has, per square meter."""
    is_hand = len(claims) > 0 and claims.raised[0]
    return config.newcomer_density if is_hand else config.bystander_density


def gate_limit(ranged: bool, gate_probability: float) -> float:
    """The largest squared distance inside the gate, of two numbers or of a bearing alone."""
    return _quantile(gate_probability, 2 if ranged else 1)


def squared_distance(
    innovation: FloatArray, spread: FloatArray, dof: float = 0.0
) -> tuple[FloatArray, FloatArray]:
    """Squared distance of innovations, and the area their S spans.

    The second number is taken given the first: y' inv(S) y is a sum of two squares then, and the
    second square is where a Student-t's tail belongs, (nu + 1) log(1 + d^2 / nu).

    Args:
        innovation: Shape (..., 2).
        spread: Shape (..., 2, 2): S.
        dof: Degrees of freedom nu of the second number; 0 is Gaussian.

    Returns:
        The distance and the determinant of S, both of shape (...).
    """
    s00, s01 = spread[..., 0, 0], spread[..., 0, 1]
    first = innovation[..., 0]
    share = s01 / s00
    rest = innovation[..., 1] - share * first
    s_rest = spread[..., 1, 1] - share * s01
    square = rest * rest / s_rest
    if dof > 0.0:
        square = (dof + 1.0) * np.log1p(square / dof)
    return first * first / s00 + square, s00 * s_rest


@dataclass(frozen=True, slots=True, eq=False)
class _Expected:
    """What one sensor would measure of tracks, and how uncertain the tracks make it."""

    values: FloatArray  # (..., N, 2)
    jacobian: FloatArray  # (..., N, 2, 2)
    doubt: FloatArray | None  # (..., N, 2, 2), from the sensor's pose
    own: FloatArray  # (..., N, 2, 2): H P H'
    spread: FloatArray  # (..., N, 2, 2): the same with the doubt, and no less than the floor


def _expect(
    mean: FloatArray, covariance: FloatArray, group: ClaimGroup, config: Config
) -> _Expected:
    if group.polar:
        values, jacobian = expect_polar(mean, group.sensor_pose)
        if not group.ranged:
            values[..., 1] = jacobian[..., 1, :] = 0.0
    else:
        values, jacobian = expect_cartesian(mean)
    own = jacobian @ covariance[..., :2, :2] @ np.swapaxes(jacobian, -1, -2)
    # Only the gate and the likelihoods see the floor, the filter does not: an over-confident
    # track shall find its measurements, and what it makes of them stays Bayes' rule.
    spread = own.copy()
    floor = config.innovation_floor_m**2 * np.einsum("...ij,...ij->...i", jacobian, jacobian)
    variance = np.einsum("...ii->...i", spread)  # a view
    np.maximum(variance, floor, out=variance)
    doubt = None
    if group.sensor_pose_covariance is not None:
        doubt = pose_noise(jacobian, group.sensor_pose_covariance)
        if not group.ranged:
            doubt[..., 1, :] = doubt[..., :, 1] = 0.0
        spread += doubt
    return _Expected(values, jacobian, doubt, own, spread)


def _pairs_of_group(belief: Belief, group: ClaimGroup, density: float, config: Config) -> Pairs:
    expected = _expect(belief.mean, belief.covariance, group, config)
    dof = config.outlier_dof if group.polar and group.ranged else 0.0
    limit = gate_limit(group.ranged, config.gate_probability)
    one = expected  # what decides on the gate: the modes' common moments
    if len(belief.weight) == 2:
        mean, covariance = belief.merged()
        one = _expect(mean[None], covariance[None], group, config)
    track, row = _inside_box(one, group, limit, dof)
    values, noise = group.values[row], group.noise[row]
    innovation, spread = _pair_up(expected, track, values, noise, group.polar)
    distance, area = squared_distance(innovation, spread, dof)
    decisive = distance
    if one is not expected:
        decisive, _ = squared_distance(*_pair_up(one, track, values, noise, group.polar), dof)
    inside = decisive[0] <= limit
    if not inside.all():
        track, row, noise, values = track[inside], row[inside], noise[inside], values[inside]
        innovation, spread = innovation[:, inside], spread[:, inside]
        distance, area = distance[:, inside], area[:, inside]

    noise = np.broadcast_to(noise, spread.shape)
    if expected.doubt is not None:
        noise = noise + expected.doubt.take(track, axis=1)
    if dof > 0.0:
        noise = outlier_noise(expected.own.take(track, axis=1), innovation, noise, dof)
    freedom = 2.0 if group.ranged else 1.0
    return Pairs(
        track,
        group.rows[row],
        innovation,
        expected.jacobian.take(track, axis=1),
        noise,
        -0.5 * (distance + np.log(area) + freedom * _LOG_TURN),
        np.log(density * area_of(group, values, config)),
    )


def area_of(group: ClaimGroup, values: FloatArray, config: Config) -> FloatArray:
    """What a unit of the measurements' own numbers covers in square meters, shape (P,).

    That is 1 for a point, r for a bearing and a range, and r_max^2 / 2 for a bearing alone: a
    density that is even over the area is so many times as large in the measurements' numbers.
    """
    if group.polar and group.ranged:
        return np.maximum(values[:, 1], 0.1)
    return np.full(len(values), config.person_range_max_m**2 / 2.0 if group.polar else 1.0)


def _pair_up(
    expected: _Expected, track: IntArray, values: FloatArray, noise: FloatArray, polar: bool
) -> tuple[FloatArray, FloatArray]:
    """Innovations of pairs, and their S."""
    innovation = values - expected.values.take(track, axis=1)
    if polar:
        innovation[..., 0] = normalize_angle(innovation[..., 0])
    return innovation, expected.spread.take(track, axis=1) + noise


def _inside_box(
    expected: _Expected, group: ClaimGroup, limit: float, dof: float
) -> tuple[IntArray, IntArray]:
    """Pairs inside the boxes around the gates' ellipses: rows of tracks, and of the group."""
    variance = expected.spread[0].diagonal(axis1=-2, axis2=-1) + group.noise.max(axis=0).diagonal()
    tail = max(limit, dof * np.expm1(limit / (dof + 1.0)) if dof > 0.0 else 0.0)
    half = np.sqrt(variance * [limit, tail])
    apart = group.values[:, 1] - expected.values[0, :, None, 1]
    # The second number first: it does not wrap, and leaves fewer pairs for the one that does.
    inside = np.abs(apart, out=apart) <= half[:, 1:]
    track, row = np.divmod(np.flatnonzero(inside), len(group.values))
    first = group.values[row, 0] - expected.values[0, track, 0]
    if group.polar:
        first = normalize_angle(first)
    near = np.abs(first) <= half[track, 0]
    return track[near], row[near]


@lru_cache(maxsize=32)
def _quantile(gate_probability: float, freedom: int) -> float:
    return float(chi2.ppf(gate_probability, freedom))
