"""Which measurements could belong to which tracks? `gating` and `claim_groups`, pair by pair."""

from __future__ import annotations

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray, SensorKind
from tracker.tracking.compiled.loop import loop, step
from tracker.tracking.compiled.prediction import TURN, merge_modes, wrapped
from tracker.tracking.compiled.settings import Settings
from tracker.tracking.outliers import ROUNDS
from tracker.tracking.sensor_model import RANGE_FLOOR_M

_POLAR, _CARTESIAN = int(SensorKind.BEARING_RANGE), int(SensorKind.POSITION)
_BEARING = int(SensorKind.BEARING)
_WORD = 8  # truth values that are read at once
_LOG_TURN = float(np.log(2.0 * np.pi))
#: What is kept of each pair and mode, in this order: the innovation, its derivatives by x and y,
#: the noise (first, mixed, second), the log-likelihood.
Y0, Y1, H00, H01, H10, H11, R00, R01, R11, LOG_LIKELIHOOD = range(10)
#: What one sensor would see of one track: bearing and range (or x and y), the derivatives, H P H',
#: the spread of the innovation without the claim's noise, and what the pose's doubt adds to it.
_E0, _E1, _J00, _J01, _J10, _J11, _P00, _P01, _P11, _S00, _S01, _S11, _D00, _D01, _D11 = range(15)
#: Of each claim: its numbers, its noise, and the log-density of newcomers there.
_Z0, _Z1, _N00, _N01, _N11, _NEWCOMER = range(6)


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
    density: float,
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
        density: Of such measurements of nobody known, per square meter.
        settings: Of the tracker.

    Returns:
        Of each of P pairs the track, the claim (0 to C - 1), the numbers named above, shape
        (P, K, 10), and the log-likelihood over the modes less that of a newcomer.
    """
    modes, tracks = weight.shape
    order, bounds, kinds = _grouped(rows, values, model, pose, doubt)
    claims = _claims(rows, order, bounds, kinds, values, noise, density, settings)
    one_mean, one_covariance = merge_modes(weight, mean, covariance)
    room = 2 * (tracks + len(rows))
    track, claim = np.empty(room, np.int64), np.empty(room, np.int64)
    numbers, odds = np.empty((room, modes, 10)), np.empty(room)
    seen = np.empty((modes + 1, 15))
    near, words = np.empty(len(rows), np.int64), np.empty(len(rows) // _WORD + 1, np.int64)
    is_near = words.view(np.bool_)
    decisive = modes if modes == 2 else 0  # row of `seen` that decides the gate
    pairs = 0
    for person in range(tracks):
        for group in range(len(kinds)):
            kind, begin, end = kinds[group], bounds[group], bounds[group + 1]
            leader = rows[order[begin]]
            for mode in range(modes):
                _expect(
                    mean[mode, person, 0], mean[mode, person, 1],
                    covariance[mode, person, 0, 0], covariance[mode, person, 0, 1],
                    covariance[mode, person, 1, 1],
                    kind, pose, doubt, leader, settings.innovation_floor_m, seen, mode,
                )  # fmt: skip
            if modes == 2:
                _expect(
                    one_mean[person, 0], one_mean[person, 1], one_covariance[person, 0, 0],
                    one_covariance[person, 0, 1], one_covariance[person, 1, 1],
                    kind, pose, doubt, leader, settings.innovation_floor_m, seen, modes,
                )  # fmt: skip
            dof = settings.outlier_dof if kind == _POLAR else 0.0
            limit = settings.bearing_limit if kind == _BEARING else settings.ranged_limit
            far = limit
            if dof > 0.0:  # ranges may be farther off, under the Student-t
                far = max(far, dof * np.expm1(limit / (dof + 1.0)))
            count = _near(
                seen, decisive, kind, limit, far, claims, begin, end, words, is_near, near
            )
            for number in range(count):
                place = near[number]
                first, second = _innovation(seen, decisive, claims, place, kind)
                distance, area = _distance(seen, decisive, claims, place, first, second, dof)
                if not distance <= limit:
                    continue
                if pairs == len(track):
                    track, claim = _twice(track), _twice(claim)
                    numbers, odds = _twice(numbers), _twice(odds)
                track[pairs], claim[pairs] = person, order[place]
                likelihood = 0.0
                for mode in range(modes):
                    if modes == 2:
                        first, second = _innovation(seen, mode, claims, place, kind)
                        distance, area = _distance(seen, mode, claims, place, first, second, dof)
                    joint = _log_likelihood(distance, area, kind)
                    _note(seen, mode, claims, place, first, second, joint, dof, numbers, pairs)
                    if modes == 2:
                        joint += np.log(weight[mode, person])
                    likelihood = joint if mode == 0 else log_of_sum(likelihood, joint)
                odds[pairs] = likelihood - claims[_NEWCOMER, place]
                pairs += 1
    return track[:pairs], claim[:pairs], numbers[:pairs], odds[:pairs]


@loop
def _claims(
    rows: IntArray,
    order: IntArray,
    bounds: IntArray,
    kinds: IntArray,
    values: FloatArray,
    noise: FloatArray,
    density: float,
    settings: Settings,
) -> FloatArray:
    """What is needed of each claim, shape (6, C), in the order of the groups."""
    claims = np.empty((6, len(rows)))
    for group in range(len(kinds)):
        kind = kinds[group]
        for place in range(bounds[group], bounds[group + 1]):
            row = rows[order[place]]
            first = values[row, 0] if kind == _CARTESIAN else wrapped(values[row, 0])
            claims[_Z0, place], claims[_N00, place] = first, noise[row, 0, 0]
            if kind == _BEARING:
                claims[_Z1, place], claims[_N01, place], claims[_N11, place] = 0.0, 0.0, 1.0
            else:
                claims[_Z1, place] = values[row, 1]
                claims[_N01, place], claims[_N11, place] = noise[row, 0, 1], noise[row, 1, 1]
            area_m2 = _area(kind, values[row, 1], settings)
            claims[_NEWCOMER, place] = np.log(density * area_m2)
    return claims


@step
def _near(
    seen: FloatArray,
    at: int,
    kind: int,
    limit: float,
    far: float,
    claims: FloatArray,
    begin: int,
    end: int,
    words: IntArray,
    is_near: BoolArray,
    near: IntArray,
) -> int:
    """Write down the claims of a group each of whose numbers, alone, could be inside the gate.

    That rules nearly all pairs out in a pass that the processor takes several claims at a time;
    its answers are read a word at a time, as most are no.
    """
    e0, e1, s00, s11 = seen[at, _E0], seen[at, _E1], seen[at, _S00], seen[at, _S11]
    turn = np.inf if kind == _CARTESIAN else TURN
    far = np.inf if kind == _BEARING else far
    words[:] = 0
    for number in range(end - begin):
        place = np.uint64(begin + number)  # rows counted from the end would forbid that
        first, second = abs(claims[_Z0, place] - e0), claims[_Z1, place] - e1
        first = min(first, turn - first)  # the way round, where that is shorter
        is_first_near = first * first <= limit * (s00 + claims[_N00, place])
        is_second_near = second * second <= far * (s11 + claims[_N11, place])
        is_near[np.uint64(number)] = is_first_near & is_second_near
    count = 0
    for word in range(len(words)):
        if words[word] != 0:
            for number in range(_WORD * word, _WORD * (word + 1)):
                if is_near[number]:
                    near[count] = begin + number
                    count += 1
    return count


@step
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
        kind = model[row]
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


@step
def _is_same_sensor(row: int, other: int, pose: FloatArray, doubt: FloatArray) -> bool:
    for i in range(3):
        if pose[row, i] != pose[other, i]:
            return False
        for j in range(3):
            if doubt[row, i, j] != doubt[other, i, j]:
                return False
    return True


@step
def _expect(
    x: float,
    y: float,
    p00: float,
    p01: float,
    p11: float,
    kind: int,
    pose: FloatArray,
    doubt: FloatArray,
    row: int,
    floor_m: float,
    seen: FloatArray,
    at: int,
) -> None:
    """What a sensor, in that row, would see of somebody; written to a row of `seen`."""
    d00 = d01 = d11 = 0.0
    e0, e1, h00, h01, h10, h11 = x, y, 1.0, 0.0, 0.0, 1.0
    if kind != _CARTESIAN:
        dx, dy = x - pose[row, 0], y - pose[row, 1]
        range_m = max(np.sqrt(dx * dx + dy * dy), RANGE_FLOOR_M)
        per_m = 1.0 / range_m
        cos, sin = dx * per_m, dy * per_m
        e0, e1 = wrapped(np.arctan2(dy, dx) - pose[row, 2]), range_m
        h00, h01, h10, h11 = -sin * per_m, cos * per_m, cos, sin
        if kind == _BEARING:
            e1 = h10 = h11 = 0.0
        d00, d01, d11 = pose_doubt(h00, h01, h10, h11, doubt, row)
    x0, y0 = h00 * p00 + h01 * p01, h00 * p01 + h01 * p11
    x1, y1 = h10 * p00 + h11 * p01, h10 * p01 + h11 * p11
    own00, own01, own11 = x0 * h00 + y0 * h01, x0 * h10 + y0 * h11, x1 * h10 + y1 * h11
    seen[at, _E0], seen[at, _E1] = e0, e1
    seen[at, _J00], seen[at, _J01], seen[at, _J10], seen[at, _J11] = h00, h01, h10, h11
    seen[at, _P00], seen[at, _P01], seen[at, _P11] = own00, own01, own11
    seen[at, _D00], seen[at, _D01], seen[at, _D11] = d00, d01, d11
    # Only the gate and the likelihoods see the floor, the filter does not.
    seen[at, _S00] = max(own00, floor_m**2 * (h00 * h00 + h01 * h01)) + d00
    seen[at, _S01] = own01 + d01
    seen[at, _S11] = max(own11, floor_m**2 * (h10 * h10 + h11 * h11)) + d11


@step
def pose_doubt(
    h00: float, h01: float, h10: float, h11: float, doubt: FloatArray, row: int
) -> tuple[float, float, float]:
    """What the pose's covariance adds to the noise: `sensor_model.pose_noise`.

    The derivatives by the sensor's x, y and yaw are (-J, (-1, 0)), all of one sign.
    """
    xx, xy, yy = doubt[row, 0, 0], doubt[row, 0, 1], doubt[row, 1, 1]
    x_turn, y_turn, turn = doubt[row, 0, 2], doubt[row, 1, 2], doubt[row, 2, 2]
    a0, a1 = xx * h00 + xy * h01 + x_turn, xy * h00 + yy * h01 + y_turn
    a2 = x_turn * h00 + y_turn * h01 + turn
    b0, b1 = xx * h10 + xy * h11, xy * h10 + yy * h11
    b2 = x_turn * h10 + y_turn * h11
    return h00 * a0 + h01 * a1 + a2, h00 * b0 + h01 * b1 + b2, h10 * b0 + h11 * b1


@step
def _innovation(
    seen: FloatArray, at: int, claims: FloatArray, place: int, kind: int
) -> tuple[float, float]:
    first, second = claims[_Z0, place] - seen[at, _E0], claims[_Z1, place] - seen[at, _E1]
    return first if kind == _CARTESIAN else wrapped(first), second


@step
def _distance(
    seen: FloatArray,
    at: int,
    claims: FloatArray,
    place: int,
    first: float,
    second: float,
    dof: float,
) -> tuple[float, float]:
    """Squared distance of the innovation, and the area that S spans: `gating.squared_distance`."""
    s00, s01 = seen[at, _S00] + claims[_N00, place], seen[at, _S01] + claims[_N01, place]
    share = s01 / s00
    rest, s_rest = second - share * first, seen[at, _S11] + claims[_N11, place] - share * s01
    square = rest * rest / s_rest
    if dof > 0.0:
        square = (dof + 1.0) * np.log1p(square / dof)
    return first * first / s00 + square, s00 * s_rest


@step
def _log_likelihood(distance: float, area: float, kind: int) -> float:
    freedom = 1.0 if kind == _BEARING else 2.0
    return -0.5 * (distance + np.log(area) + freedom * _LOG_TURN)


@step
def _note(
    seen: FloatArray,
    at: int,
    claims: FloatArray,
    place: int,
    first: float,
    second: float,
    log_likelihood: float,
    dof: float,
    numbers: FloatArray,
    pair: int,
) -> None:
    """Write down the numbers of a pair in a mode of motion."""
    r00, r01 = claims[_N00, place] + seen[at, _D00], claims[_N01, place] + seen[at, _D01]
    r11 = claims[_N11, place] + seen[at, _D11]
    if dof > 0.0:
        r11 = _outlier_variance(seen, at, first, second, r00, r01, r11, dof)
    numbers[pair, at, Y0], numbers[pair, at, Y1] = first, second
    numbers[pair, at, H00], numbers[pair, at, H01] = seen[at, _J00], seen[at, _J01]
    numbers[pair, at, H10], numbers[pair, at, H11] = seen[at, _J10], seen[at, _J11]
    numbers[pair, at, R00], numbers[pair, at, R01], numbers[pair, at, R11] = r00, r01, r11
    numbers[pair, at, LOG_LIKELIHOOD] = log_likelihood


@step
def _outlier_variance(
    seen: FloatArray,
    at: int,
    first: float,
    second: float,
    r00: float,
    r01: float,
    r11: float,
    dof: float,
) -> float:
    """The range's variance, raised where the range fits badly: `outliers.outlier_noise`."""
    share = (seen[at, _P01] + r01) / (seen[at, _P00] + r00)
    y = second - share * first
    r = r11 - r01 * r01 / r00
    a = max(seen[at, _P11] + r11 - share * (seen[at, _P01] + r01) - r, 0.0)
    weight = 1.0
    for _ in range(ROUNDS):
        scaled = r / weight
        posterior = scaled / (a + scaled)
        weight = (dof + 1.0) / (dof + (posterior * y * y * posterior + a * posterior) / r)
        weight = min(weight, 1.0)
    return r11 + r * (1.0 / weight - 1.0)


@step
def _area(kind: int, range_m: float, settings: Settings) -> float:
    """What a unit of the claim's own numbers covers: `gating.area_of`."""
    if kind == _CARTESIAN:
        return 1.0
    if kind == _BEARING:
        return settings.person_range_max_m**2 / 2.0
    return max(range_m, 0.1)
