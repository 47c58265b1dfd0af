"""Which measurements may come in? `tracker.tracking.admission`, row by row."""

from __future__ import annotations

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray, MeasurementModel
from tracker.tracking.admission import (
    ABSURD_M,
    BEARING_VARIANCE_MAX,
    VARIANCE_MAX,
    VARIANCE_MIN,
)
from tracker.tracking.compiled.loop import loop

_POLAR = int(MeasurementModel.POLAR)


@loop
def admit(
    values: FloatArray,
    covariance: FloatArray,
    model: IntArray,
    pose: FloatArray,
    is_raised: BoolArray,
    person: IntArray,
    may_enter: BoolArray,
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
        unknown_range_m: Supposed range of a bearing alone.
        same_person_distance_m: Two hands closer together are one person's.
    """
    count = len(values)
    raised, others = np.empty(count, np.int64), np.empty(count, np.int64)
    xy = np.empty((count, 2))
    hands = rest = 0
    for row in range(count):
        if not (
            may_enter[row] and _is_usable(values[row], covariance[row], model[row], pose[row])
        ):
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
        if model[row] == _POLAR:
            range_m = unknown_range_m if np.isnan(y) else y
            angle = x + pose[row, 2]
            x, y = pose[row, 0] + range_m * np.cos(angle), pose[row, 1] + range_m * np.sin(angle)
        is_new = True
        for earlier in range(kept):
            across, along = x - xy[earlier, 0], y - xy[earlier, 1]
            is_new &= not across * across + along * along < same_person_distance_m**2
        if is_new:
            raised[kept], xy[kept, 0], xy[kept, 1] = row, x, y
            kept += 1
    return raised[:kept], others[:rest]


@loop
def _is_usable(values: FloatArray, covariance: FloatArray, model: int, pose: FloatArray) -> bool:
    first, second = covariance[0, 0], covariance[1, 1]
    is_polar = model == _POLAR
    # NaN compares as false, which is what is meant throughout.
    if not abs(values[0]) < ABSURD_M:
        return False
    if not (abs(values[1]) < ABSURD_M or (is_polar and np.isnan(values[1]))):
        return False
    for number in pose:
        if not abs(number) < ABSURD_M:
            return False
    if is_polar and values[1] < 0.0:
        return False
    if not (first > VARIANCE_MIN and second > VARIANCE_MIN and second < VARIANCE_MAX):
        return False
    if not first < (BEARING_VARIANCE_MAX if is_polar else VARIANCE_MAX):
        return False
    mixed, mirrored, spread = covariance[0, 1], covariance[1, 0], np.sqrt(first) * np.sqrt(second)
    return abs(mixed) < (1.0 - 1e-9) * spread and abs(mixed - mirrored) <= 1e-9 * spread
