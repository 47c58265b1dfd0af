"""The frame of `batched_tracker` as one loop over the trials, compiled by numba.

Trial by trial everything stays in the processor's nearest memory, and the assignment too is solved
here. The equations stand in `batched_tracker`, and what they give is the same up to rounding. The
machine code is kept on disk, so that only the first run on a machine waits for the compiler.
"""

from __future__ import annotations

import numpy as np

from tracker.containers import BoolArray, FloatArray
from tracker.tracking.compiled.association import assign
from tracker.tracking.compiled.kept import kept
from tracker.tracking.compiled.loop import step
from tracker.tracking.compiled.prediction import wrapped
from tracker.tracking.sensor_model import RANGE_FLOOR_M


@kept()
def track_frame(
    mean: FloatArray,
    covariance: FloatArray,
    bearing_rad: FloatArray,
    range_m: FloatArray,
    chosen: BoolArray,
    dt_s: float,
    density: float,
    bearing_variance: float,
    range_variance: float,
    limit: float,
    floor_m: float,
    offset: float,
) -> None:
    """Predict, gate, assign and correct, in place.

    Args:
        mean: Shape (4, N, B).
        covariance: Shape (4, 4, N, B).
        bearing_rad: Shape (M, B); NaN where a trial has fewer than M.
        range_m: Shape (M, B).
        chosen: Shape (M, N, B), all false: filled in.
        dt_s: Since the last frame.
        density: Process noise, m^2/s^3.
        bearing_variance: Noise of the bearings.
        range_variance: Noise of the ranges.
        limit: The gate's, of squared distances.
        floor_m: Under the innovations' spread, for the gate.
        offset: What all log-odds have in common.
    """
    people, measured = mean.shape[1], len(bearing_rad)
    first, second, gain = np.empty((3, people, measured))
    expected = np.empty((people, 9))  # bearing, range, cos, sin, d bearing, H P H'
    root, farness = np.empty((4, 2)), np.empty(measured)
    row_of, is_taken = np.empty(people, np.int64), np.empty(measured, np.bool_)
    for trial in range(mean.shape[2]):
        for row in range(measured):
            farness[row] = np.log(max(range_m[row, trial], 0.1))
        for person in range(people):
            own_mean, own = mean[:, person, trial], covariance[:, :, person, trial]
            _predict(own_mean, own, dt_s, density)
            seen = expected[person]
            _expect(own_mean, own, seen)
            bearing, distance, cos, sin, turn_x, turn_y, own00, own01, own11 = seen
            s00 = max(own00, floor_m**2 * (turn_x**2 + turn_y**2)) + bearing_variance
            s11 = max(own11, floor_m**2 * (cos**2 + sin**2)) + range_variance
            share = own01 / s00
            s_rest = s11 - share * own01
            level = offset - 0.5 * np.log(s00 * s_rest)
            w00, w_rest = 1.0 / s00, 1.0 / s_rest
            for row in range(measured):
                turned = wrapped(bearing_rad[row, trial] - bearing)
                farther = range_m[row, trial] - distance
                rest = farther - share * turned
                square = turned * turned * w00 + rest * rest * w_rest
                first[person, row], second[person, row] = turned, farther
                gain[person, row] = 0.0
                if square <= limit:
                    gain[person, row] = max(level - 0.5 * square - farness[row], 0.0)
        assign(gain, row_of, is_taken)
        for person in range(people):
            row = row_of[person]
            if row >= 0:
                chosen[row, person, trial] = True
                _correct(
                    mean[:, person, trial],
                    covariance[:, :, person, trial],
                    expected[person],
                    first[person, row],
                    second[person, row],
                    bearing_variance,
                    range_variance,
                    root,
                )


@step
def _predict(mean: FloatArray, covariance: FloatArray, dt_s: float, density: float) -> None:
    for axis in range(2):
        mean[axis] += dt_s * mean[axis + 2]
    for axis in range(2):
        for column in range(4):
            covariance[axis, column] += dt_s * covariance[axis + 2, column]
    for row in range(4):
        for axis in range(2):
            covariance[row, axis] += dt_s * covariance[row, axis + 2]
    for axis in range(2):
        covariance[axis, axis] += density * (dt_s**3 / 3)
        covariance[axis, axis + 2] += density * (dt_s**2 / 2)
        covariance[axis + 2, axis] += density * (dt_s**2 / 2)
        covariance[axis + 2, axis + 2] += density * dt_s


@step
def _expect(mean: FloatArray, covariance: FloatArray, expected: FloatArray) -> None:
    x, y = mean[0], mean[1]
    distance = max(np.sqrt(x * x + y * y), RANGE_FLOOR_M)
    per_m = 1.0 / distance
    cos, sin = x * per_m, y * per_m
    turn_x, turn_y = -sin * per_m, cos * per_m
    p00, p01, p11 = covariance[0, 0], covariance[0, 1], covariance[1, 1]
    by_bearing0, by_bearing1 = p00 * turn_x + p01 * turn_y, p01 * turn_x + p11 * turn_y
    by_range0, by_range1 = p00 * cos + p01 * sin, p01 * cos + p11 * sin
    expected[0], expected[1] = np.arctan2(y, x), distance
    expected[2], expected[3], expected[4], expected[5] = cos, sin, turn_x, turn_y
    expected[6] = turn_x * by_bearing0 + turn_y * by_bearing1
    expected[7] = cos * by_bearing0 + sin * by_bearing1
    expected[8] = cos * by_range0 + sin * by_range1


@step
def _correct(
    mean: FloatArray,
    covariance: FloatArray,
    expected: FloatArray,
    first: float,
    second: float,
    bearing_variance: float,
    range_variance: float,
    root: FloatArray,
) -> None:
    _, _, cos, sin, turn_x, turn_y, own00, own01, own11 = expected
    per_l00 = 1.0 / np.sqrt(own00 + bearing_variance)
    l10 = own01 * per_l00
    per_l11 = 1.0 / np.sqrt(own11 + range_variance - l10 * l10)
    y0 = first * per_l00
    y1 = (second - l10 * y0) * per_l11
    for row in range(4):
        to_x, to_y = covariance[row, 0], covariance[row, 1]
        root[row, 0] = (to_x * turn_x + to_y * turn_y) * per_l00
        root[row, 1] = (to_x * cos + to_y * sin - l10 * root[row, 0]) * per_l11
        mean[row] += root[row, 0] * y0 + root[row, 1] * y1
    for row in range(4):
        for column in range(4):
            covariance[row, column] -= (
                root[row, 0] * root[column, 0] + root[row, 1] * root[column, 1]
            )
