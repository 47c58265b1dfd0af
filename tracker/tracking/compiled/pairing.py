"""Which measurements could belong to which tracks? `gating` and `claim_groups`, pair by pair."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray, IntArray, MeasurementModel
from tracker.tracking.compiled.loop import loop
from tracker.tracking.compiled.prediction import merge_modes, wrapped
from tracker.tracking.compiled.settings import Settings
from tracker.tracking.outliers import ROUNDS
from tracker.tracking.sensor_model import RANGE_FLOOR_M

_POLAR, _CARTESIAN = int(MeasurementModel.POLAR), int(MeasurementModel.CARTESIAN)
_BEARING = -1  # kind of a claim without a range
_LOG_TURN = float(np.log(2.0 * np.pi))
#: What is kept of each pair and mode, in this order: the innovation, its derivatives by x and y,
#: the noise (first, mixed, second), the log-likelihood.
Y0, Y1, H00, H01, H10, H11, R00, R01, R11, LOG_LIKELIHOOD = range(10)
#: What one sensor would see of one track: bearing and range (or x and y), the derivatives, H P H',
#: the spread of the innovation without the claim's noise, and what the pose's doubt adds to it.
_E0, _E1, _J00, _J01, _J10, _J11, _P00, _P01, _P11, _S00, _S01, _S11, _D00, _D01, _D11 = range(15)


@loop
def find_pairs(
    weight: FloatArray,
    mean: FloatArray,
    covariance: FloatArray,
    rows: IntArray,
    values: FloatArray,
    noise: FloatArray,
    model: IntArray,
    pose: FloatArray,
    doubt: FloatArray,
    settings: Settings,
) -> tuple[IntArray, IntArray, FloatArray, FloatArray]:
    """Pairs inside the gate, by track, then by claim: `gating.find_pairs`.

    Args:
        weight: Shape (K, N).
        mean: Shape (K, N, 4).
        covariance: Shape (K, N, 4, 4).
        rows: Shape (C,): the measurements that count, as rows of the following.
        values: Shape (M, 2), and so on: the arrays of `Measurements`.
        noise: Shape (M, 2, 2).
        model: Shape (M,).
        pose: Shape (M, 3).
        doubt: Shape (M, 3, 3).
        settings: Of the tracker.

    Returns:
        Of each of P pairs the track, the claim (0 to C - 1), the numbers named above, shape
        (P, K, 10), and the log-likelihood over the modes less that of a newcomer.
    """
    modes, tracks = weight.shape
    order, bounds, kinds = _grouped(rows, values, model, pose, doubt)
    one_mean, one_covariance = merge_modes(weight, mean, covariance)
    room = 2 * (tracks + len(rows))
    track, claim = np.empty(room, np.int64), np.empty(room, np.int64)
    numbers, odds = np.empty((room, modes, 10)), np.empty(room)
    seen, near = np.empty((modes + 1, 15)), np.empty(len(rows), np.int64)
    decisive = seen[modes] if modes == 2 else seen[0]
    pairs = 0
    for person in range(tracks):
        for group in range(len(kinds)):
            kind, leader = kinds[group], rows[order[bounds[group]]]
            for mode in range(modes):
                _expect(
                    mean[mode, person], covariance[mode, person], kind,
                    pose[leader], doubt[leader], settings.innovation_floor_m, seen[mode],
                )  # fmt: skip
            if modes == 2:
                _expect(
                    one_mean[person], one_covariance[person], kind,
                    pose[leader], doubt[leader], settings.innovation_floor_m, seen[modes],
                )  # fmt: skip
            dof = settings.outlier_dof if kind == _POLAR else 0.0
            limit = settings.bearing_limit if kind == _BEARING else settings.ranged_limit
            count = _inside_box(
                decisive, kind, limit, dof, rows, order[bounds[group] : bounds[group + 1]],
                values, noise, near,
            )  # fmt: skip
            for number in near[:count]:
                row = rows[number]
                distance, _ = _distance(decisive, values[row], noise[row], kind, dof)
                if not distance <= limit:
                    continue
                if pairs == len(track):
                    track, claim = _twice(track), _twice(claim)
                    numbers, odds = _twice(numbers), _twice(odds)
                track[pairs], claim[pairs] = person, number
                likelihood = -np.inf
                for mode in range(modes):
                    _compare(seen[mode], values[row], noise[row], kind, dof, numbers[pairs, mode])
                    joint = numbers[pairs, mode, LOG_LIKELIHOOD]
                    if modes == 2:
                        joint += np.log(weight[mode, person])
                    likelihood = log_of_sum(likelihood, joint)
                odds[pairs] = likelihood - np.log(_newcomer_density(kind, values[row], settings))
                pairs += 1
    return track[:pairs], claim[:pairs], numbers[:pairs], odds[:pairs]


@loop
def _inside_box(
    seen: FloatArray,
    kind: int,
    limit: float,
    dof: float,
    rows: IntArray,
    claims: IntArray,
    values: FloatArray,
    noise: FloatArray,
    near: IntArray,
) -> int:
    """Claims inside the box around the gate's ellipse, written to `near`; says how many.

    Each of the two numbers alone rules most pairs out, and the second one, which does not wrap,
    does so at the lowest price.
    """
    first_seen, second_seen, s00, s11 = seen[_E0], seen[_E1], seen[_S00], seen[_S11]
    tail = limit
    if dof > 0.0:  # ranges may be farther off, under the Student-t
        tail = max(limit, dof * np.expm1(limit / (dof + 1.0)))
    count = 0
    for claim in claims:
        row = rows[claim]
        second = values[row, 1] - second_seen
        if kind != _BEARING and second * second > tail * (s11 + noise[row, 1, 1]):
            continue
        first = values[row, 0] - first_seen
        if kind != _CARTESIAN:
            first = wrapped(first)
        if first * first <= limit * (s00 + noise[row, 0, 0]):
            near[count] = claim
            count += 1
    return count


@loop
def log_of_sum(first: float, second: float) -> float:
    """log(exp(a) + exp(b)) without overflow."""
    most = max(first, second)
    if most == -np.inf:
        return most
    return most + np.log1p(np.exp(-abs(first - second)))


@loop
def _twice(array: FloatArray) -> FloatArray:
    longer = np.empty((2 * len(array), *array.shape[1:]), array.dtype)
    longer[: len(array)] = array
    return longer


@loop
def _grouped(
    rows: IntArray, values: FloatArray, model: IntArray, pose: FloatArray, doubt: FloatArray
) -> tuple[IntArray, IntArray, IntArray]:
    """Claims by kind and sensor pose: their order, where each group begins, and its kind."""
    group, leader = np.empty(len(rows), np.int64), np.empty(len(rows), np.int64)
    kinds, bounds = np.empty(len(rows), np.int64), np.zeros(len(rows) + 1, np.int64)
    groups = 0
    for number in range(len(rows)):
        row = rows[number]
        kind = _BEARING if np.isnan(values[row, 1]) else model[row]
        mine = -1
        for known in range(groups):
            if kinds[known] == kind and _is_same_sensor(row, leader[known], pose, doubt):
                mine = known
                break
        if mine < 0:
            mine, leader[groups], kinds[groups] = groups, row, kind
            groups += 1
        group[number] = mine
        bounds[mine + 1] += 1
    bounds, order = np.cumsum(bounds), np.empty(len(rows), np.int64)
    filled = bounds.copy()
    for number in range(len(rows)):
        order[filled[group[number]]] = number
        filled[group[number]] += 1
    return order, bounds, kinds[:groups]


@loop
def _is_same_sensor(row: int, other: int, pose: FloatArray, doubt: FloatArray) -> bool:
    for i in range(3):
        if pose[row, i] != pose[other, i]:
            return False
        for j in range(3):
            if doubt[row, i, j] != doubt[other, i, j]:
                return False
    return True


@loop
def _expect(
    mean: FloatArray,
    covariance: FloatArray,
    kind: int,
    pose: FloatArray,
    doubt: FloatArray,
    floor_m: float,
    seen: FloatArray,
) -> None:
    seen[_D00] = seen[_D01] = seen[_D11] = 0.0
    if kind == _CARTESIAN:
        seen[_E0], seen[_E1] = mean[0], mean[1]
        seen[_J00] = seen[_J11] = 1.0
        seen[_J01] = seen[_J10] = 0.0
    else:
        dx, dy = mean[0] - pose[0], mean[1] - pose[1]
        range_m = max(np.hypot(dx, dy), RANGE_FLOOR_M)
        cos, sin = dx / range_m, dy / range_m
        seen[_E0], seen[_E1] = np.arctan2(dy, dx) - pose[2], range_m
        seen[_J00], seen[_J01] = -sin / range_m, cos / range_m
        seen[_J10], seen[_J11] = cos, sin
        if kind == _BEARING:
            seen[_E1] = seen[_J10] = seen[_J11] = 0.0
        seen[_D00], seen[_D01], seen[_D11] = pose_doubt(
            seen[_J00], seen[_J01], seen[_J10], seen[_J11], doubt
        )
    h00, h01, h10, h11 = seen[_J00], seen[_J01], seen[_J10], seen[_J11]
    p00, p01, p11 = covariance[0, 0], covariance[0, 1], covariance[1, 1]
    x0, y0 = h00 * p00 + h01 * p01, h00 * p01 + h01 * p11
    x1, y1 = h10 * p00 + h11 * p01, h10 * p01 + h11 * p11
    seen[_P00], seen[_P01], seen[_P11] = (
        x0 * h00 + y0 * h01,
        x0 * h10 + y0 * h11,
        x1 * h10 + y1 * h11,
    )
    # Only the gate and the likelihoods see the floor, the filter does not.
    seen[_S00] = max(seen[_P00], floor_m**2 * (h00 * h00 + h01 * h01)) + seen[_D00]
    seen[_S01] = seen[_P01] + seen[_D01]
    seen[_S11] = max(seen[_P11], floor_m**2 * (h10 * h10 + h11 * h11)) + seen[_D11]


@loop
def pose_doubt(
    h00: float, h01: float, h10: float, h11: float, doubt: FloatArray
) -> tuple[float, float, float]:
    """What the pose's covariance adds to the noise: `sensor_model.pose_noise`.

    The derivatives by the sensor's x, y and yaw are (-J, (-1, 0)), all of one sign.
    """
    xx, xy, yy, turn = doubt[0, 0], doubt[0, 1], doubt[1, 1], doubt[2, 2]
    a0, a1 = xx * h00 + xy * h01 + doubt[0, 2], xy * h00 + yy * h01 + doubt[1, 2]
    a2 = doubt[0, 2] * h00 + doubt[1, 2] * h01 + turn
    b0, b1 = xx * h10 + xy * h11, xy * h10 + yy * h11
    b2 = doubt[0, 2] * h10 + doubt[1, 2] * h11
    return h00 * a0 + h01 * a1 + a2, h00 * b0 + h01 * b1 + b2, h10 * b0 + h11 * b1


@loop
def _innovation(seen: FloatArray, values: FloatArray, kind: int) -> tuple[float, float]:
    first = values[0] - seen[_E0]
    if kind != _CARTESIAN:
        first = wrapped(first)
    return first, 0.0 if kind == _BEARING else values[1] - seen[_E1]


@loop
def _noise(noise: FloatArray, kind: int) -> tuple[float, float, float]:
    if kind == _BEARING:
        return noise[0, 0], 0.0, 1.0
    return noise[0, 0], noise[0, 1], noise[1, 1]


@loop
def _distance(
    seen: FloatArray, values: FloatArray, noise: FloatArray, kind: int, dof: float
) -> tuple[float, float]:
    """Squared distance of the innovation, and the area that S spans: `gating.squared_distance`."""
    first, second = _innovation(seen, values, kind)
    r00, r01, r11 = _noise(noise, kind)
    s00, s01 = seen[_S00] + r00, seen[_S01] + r01
    share = s01 / s00
    rest, s_rest = second - share * first, seen[_S11] + r11 - share * s01
    square = rest * rest / s_rest
    if dof > 0.0:
        square = (dof + 1.0) * np.log1p(square / dof)
    return first * first / s00 + square, s00 * s_rest


@loop
def _compare(
    seen: FloatArray,
    values: FloatArray,
    noise: FloatArray,
    kind: int,
    dof: float,
    numbers: FloatArray,
) -> None:
    first, second = _innovation(seen, values, kind)
    r00, r01, r11 = _noise(noise, kind)
    distance, area = _distance(seen, values, noise, kind, dof)
    freedom = 1.0 if kind == _BEARING else 2.0
    r00, r01, r11 = r00 + seen[_D00], r01 + seen[_D01], r11 + seen[_D11]
    if dof > 0.0:
        r11 = _outlier_variance(seen, first, second, r00, r01, r11, dof)
    numbers[Y0], numbers[Y1] = first, second
    numbers[H00], numbers[H01] = seen[_J00], seen[_J01]
    numbers[H10], numbers[H11] = seen[_J10], seen[_J11]
    numbers[R00], numbers[R01], numbers[R11] = r00, r01, r11
    numbers[LOG_LIKELIHOOD] = -0.5 * (distance + np.log(area) + freedom * _LOG_TURN)


@loop
def _outlier_variance(
    seen: FloatArray, first: float, second: float, r00: float, r01: float, r11: float, dof: float
) -> float:
    """The range's variance, raised where the range fits badly: `outliers.outlier_noise`."""
    share = (seen[_P01] + r01) / (seen[_P00] + r00)
    y = second - share * first
    r = r11 - r01 * r01 / r00
    a = max(seen[_P11] + r11 - share * (seen[_P01] + r01) - r, 0.0)
    weight = 1.0
    for _ in range(ROUNDS):
        scaled = r / weight
        posterior = scaled / (a + scaled)
        weight = (dof + 1.0) / (dof + (posterior * y * y * posterior + a * posterior) / r)
        weight = min(weight, 1.0)
    return r11 + r * (1.0 / weight - 1.0)


@loop
def _newcomer_density(kind: int, values: FloatArray, settings: Settings) -> float:
    if kind == _CARTESIAN:
        return settings.newcomer_density
    if kind == _BEARING:
        return settings.newcomer_density * settings.person_range_max_m**2 / 2.0
    return settings.newcomer_density * max(values[1], 0.1)
