"""Where do ranges to one person meet? Ranges from three sensors give a position.

Least squares over the ranges. Two sensors, or a line of them, leave a second place, and a single
range is a ring: those are left as they are, and correct people who are tracked already.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import chi2

from tracker.containers.arrays import FloatArray, IntArray
from tracker.containers.measurements import Measurements
from tracker.containers.sensor_kind import SensorKind

_RANGE = int(SensorKind.RANGE)
#: Sensors are in line where they spread across no more than so large a share of that along.
_IN_LINE = 0.1
#: Ranges that fit worse in one of so many cases are taken for ranges to several people.
_MEET = 0.9999


def with_positions(measurements: Measurements) -> Measurements:
    """The same measurements, ranges alone that meet as one position in place of the first.

    Ranges that share `raised`, `person` and `identity` may meet.

    Args:
        measurements: M of them.
    """
    if measurements.kind.tolist().count(_RANGE) < 3:  # as nearly always, said fast
        return measurements
    alone = measurements.kind == _RANGE
    keys = np.stack([measurements.raised, measurements.person, measurements.identity], axis=1)
    values, covariance = measurements.values.copy(), measurements.covariance.copy()
    kind, keep = measurements.kind.copy(), np.ones(len(measurements), dtype=bool)
    for key in np.unique(keys[alone], axis=0):
        rows = np.flatnonzero(alone & (keys == key).all(axis=1))
        met = _meeting_point(measurements, rows)
        if met is not None:
            values[rows[0]], covariance[rows[0]] = met
            kind[rows[0]] = SensorKind.POSITION
            keep[rows[1:]] = False
    pose = np.where((kind == SensorKind.POSITION)[:, None], 0.0, measurements.sensor_pose)
    joined = replace(
        measurements, values=values, covariance=covariance, kind=kind, sensor_pose=pose
    )
    return joined[keep]


def _meeting_point(
    measurements: Measurements, rows: IntArray
) -> tuple[FloatArray, FloatArray] | None:
    """Position and covariance, shapes (2,) and (2, 2); None where the ranges do not meet."""
    sensor_m, range_m = measurements.sensor_pose[rows, :2], measurements.values[rows, 1]
    spread = np.linalg.svd(sensor_m - sensor_m.mean(axis=0), compute_uv=False)
    if len(rows) < 3 or spread[1] <= _IN_LINE * spread[0]:
        return None
    doubt = measurements.sensor_pose_covariance[rows, 0, 0]
    doubt = np.maximum(doubt, measurements.sensor_pose_covariance[rows, 1, 1])
    std_m = np.sqrt(measurements.covariance[rows, 1, 1] + doubt)

    def misfit(xy_m: FloatArray) -> FloatArray:
        away_m = np.hypot(*(xy_m - sensor_m).T)
        return np.asarray((away_m - range_m) / std_m)

    solved = least_squares(misfit, _first_guess(sensor_m, range_m), method="lm")
    if 2.0 * solved.cost > chi2.ppf(_MEET, len(rows) - 2):
        return None
    return solved.x, np.linalg.inv(solved.jac.T @ solved.jac)


def _first_guess(sensor_m: FloatArray, range_m: FloatArray) -> FloatArray:
    """Where the circles' differences from the first one meet, which are straight lines.

    With s_0 at the origin: 2 (s_i - s_0)' x = |s_i|^2 - |s_0|^2 - (r_i^2 - r_0^2).
    """
    apart_m = sensor_m[1:] - sensor_m[0]
    right = (apart_m**2).sum(axis=1) - range_m[1:] ** 2 + range_m[0] ** 2
    solved, *_ = np.linalg.lstsq(2.0 * apart_m, right, rcond=None)
    return np.asarray(sensor_m[0] + solved)
