"""Which measurements may come in? `tracker.tracking.admission`, row by row."""

from __future__ import annotations

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray, SensorKind
from tracker.containers.measurement_check import (
    ABSURD_M,
    BEARING_VARIANCE_MAX,
    VARIANCE_MAX,
    VARIANCE_MIN,
)
from tracker.tracking.admission import CALLER_REACH_M
from tracker.tracking.compiled.loop import loop, step

_POSITION = int(SensorKind.POSITION)


@loop
def admit(
    values: FloatArray,
    covariance: FloatArray,
    model: IntArray,
    pose: FloatArray,
    is_raised: BoolArray,
    person: IntArray,
    may_enter: BoolArray,
    place: FloatArray,
    calls: BoolArray,
    unknown_range_m: float,
    same_person_distance_m: float,
) -> tuple[IntArray, IntArray]:
    """Rows of raised hands, one per person, and rows of everything else.

    Args:
        values: Shape (M, 2), and so on: the arrays of `Measurements`.
        covariance: Shape (M, 2, 2).
        model: Shape (M,).
        pose: Shape (M, 3).
        is_raised: Shape (M,).
        person: Shape (M,).
        may_enter: Shape (M,): false where the doubt about the sensor's pose is no covariance.
        place: Shape (N, 4): where people are expected.
        calls: Shape (N,): their hands were up.
        unknown_range_m: Supposed range of a bearing alone.
        same_person_distance_m: Two hands closer together are one person's, unless two call there.
    """
    count = len(values)
    raised, others = np.empty(count, np.int64), np.empty(count, np.int64)
    x_m, y_m = np.empty(count), np.empty(count)
    hands = rest = 0
    for row in range(count):
        if not (may_enter[row] and _is_usable(values, covariance, model, pose, row)):
            continue
        if not is_raised[row]:
            others[rest] = row
            rest += 1
            continue
        is_new = True
        if person[row] >= 0:
            for earlier in range(hands):
                is_new &= person[raised[earlier]] != person[row]
        if is_new:
            raised[hands] = row
            hands += 1
    # Whoever has been counted keeps out the rows after them, and only those who count do.
    kept = 0
    for number in range(hands):
        row = raised[number]
        x, y = values[row, 0], values[row, 1]
        if model[row] != _POSITION:
            range_m = unknown_range_m if np.isnan(y) else y
            angle = x + pose[row, 2]
            x, y = pose[row, 0] + range_m * np.cos(angle), pose[row, 1] + range_m * np.sin(angle)
        near = 0
        for earlier in range(kept):
            across, along = x - x_m[earlier], y - y_m[earlier]
            near += across * across + along * along < same_person_distance_m**2
        if near == 0 or near < _callers(x, y, place, calls):
            raised[kept], x_m[kept], y_m[kept] = row, x, y
            kept += 1
    return raised[:kept], others[:rest]


@loop
def _callers(x: float, y: float, place: FloatArray, calls: BoolArray) -> int:
    """How many call who are expected there."""
    count = 0
    for person in range(len(calls)):
        across, along = x - place[person, 0], y - place[person, 1]
        is_there = across * across + along * along < CALLER_REACH_M**2
        count += calls[person] and is_there
    return count


@step
def _is_usable(
    values: FloatArray, covariance: FloatArray, model: IntArray, pose: FloatArray, row: int
) -> bool:
    first, second = covariance[row, 0, 0], covariance[row, 1, 1]
    is_polar = model[row] != _POSITION
    # NaN compares as false, which is what is meant throughout.
    if not abs(values[row, 0]) < ABSURD_M:
        return False
    if not (abs(values[row, 1]) < ABSURD_M or (is_polar and np.isnan(values[row, 1]))):
        return False
    for number in range(3):
        if not abs(pose[row, number]) < ABSURD_M:
            return False
    if is_polar and values[row, 1] < 0.0:
        return False
    if not (first > VARIANCE_MIN and second > VARIANCE_MIN and second < VARIANCE_MAX):
        return False
    if not first < (BEARING_VARIANCE_MAX if is_polar else VARIANCE_MAX):
        return False
    mixed, mirrored = covariance[row, 0, 1], covariance[row, 1, 0]
    if mixed == 0.0 and mirrored == 0.0:
        return True
    spread = np.sqrt(first) * np.sqrt(second)
    return abs(mixed) < (1.0 - 1e-9) * spread and abs(mixed - mirrored) <= 1e-9 * spread
