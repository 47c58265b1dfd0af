"""Which measurements can a tracker use, and what is wrong with the others?

A tracker can use finite numbers with a positive definite covariance, in the order of magnitude of
people and sensors. Beyond the limits below, squares and sums drown in rounding.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

import numpy as np

from tracker.containers.arrays import BoolArray, FloatArray
from tracker.containers.sensor_kind import ABSENT, SensorKind
from tracker.errors import MeasurementError

if TYPE_CHECKING:
    from tracker.containers.measurements import Measurements

#: Farther than this from the fixed frame's origin there is no person; the Earth ends at 1e8 m.
ABSURD_M = 1e9
#: Variances between which a sensor's noise lies, in square meters or square radians.
VARIANCE_MIN, VARIANCE_MAX = 1e-12, 1e9
#: A bearing whose standard deviation is a full turn says nothing.
BEARING_VARIANCE_MAX = (2.0 * np.pi) ** 2
#: Standard deviations, in meters or radians, well inside those limits.
_ORDINARY_STD_MIN, _ORDINARY_STD_MAX = 1e-5, 6.0
#: Asymmetry that rounding leaves, and what a correlation must stay below 1 by.
_ROUNDING = 1e-9

_KINDS = frozenset(map(int, SensorKind))
_ALONE = frozenset({int(SensorKind.BEARING), int(SensorKind.RANGE)})
_POSITIONS = frozenset({int(SensorKind.POSITION)})

#: Covariances that may be zero, and when to leave them out.
_WITHOUT = {
    "sensor_pose_covariance": "Leave it out (None) if the sensor's pose is well known.",
    "bias_covariance": "Leave it out (None) if no part of the error lasts.",
}

#: What becomes of rows that a tracker cannot use.
Refuse: TypeAlias = Literal["raise", "drop"]


def check_measurements(claims: Measurements) -> None:
    """Refuse measurements that a tracker cannot use.

    Args:
        claims: Of the right shapes.

    Raises:
        MeasurementError: Names the first such row, what it holds, what is needed and the remedy.
    """
    if _are_plain(claims):
        return
    faults = [fault for fault in _faults(claims) if fault.rows.any()]
    if not faults:
        return
    row = int(np.flatnonzero(np.logical_or.reduce([fault.rows for fault in faults]))[0])
    fault = next(fault for fault in faults if fault.rows[row])
    raise MeasurementError(
        f"Row {row} of {len(claims)} measurements has {fault.got(row)}; expected: {fault.needed}. "
        f"{fault.remedy}"
    )


def usable_rows(claims: Measurements) -> BoolArray:
    """Shape (M,): which rows a tracker can use.

    Args:
        claims: M measurements of the right shapes.
    """
    if _are_plain(claims):
        return np.ones(len(claims), dtype=bool)
    return np.asarray(~np.logical_or.reduce([fault.rows for fault in _faults(claims)]))


def are_ordinary(known: FloatArray, std: FloatArray, sensor_pose: FloatArray) -> bool:
    """Whether bearings and ranges are so ordinary that they need no detailed check.

    This asks for more than is needed, in a microsecond. A sum of squares bounds each of its
    numbers, `argmin` finds NaN before any number, and NaN fails every comparison.

    Args:
        known: Shape (M, 2): bearing and range, 1 in the place of what is not measured.
        std: Shape (M, 2): their standard deviations, 1 in the same places.
        sensor_pose: Shape (M, 3), well known.
    """
    if len(known) == 0:
        return True
    range_m, noise = known[:, 1], std.ravel()
    return bool(
        _sum_of_squares(known) < ABSURD_M**2
        and _sum_of_squares(sensor_pose) < ABSURD_M**2
        and range_m[range_m.argmin()] >= 0.0
        and noise[noise.argmin()] > _ORDINARY_STD_MIN
        and noise[noise.argmax()] < _ORDINARY_STD_MAX
    )


def _sum_of_squares(numbers: FloatArray) -> float:
    # Of more numbers BLAS would wake up threads, which takes milliseconds.
    return float(np.vdot(numbers, numbers) if numbers.size < 10_000 else np.square(numbers).sum())


def _are_plain(claims: Measurements) -> bool:
    """A quick check of all rows at once: nothing is wrong and nothing unusual.

    A sum of squares bounds each of its numbers, and NaN fails every comparison.
    """
    if len(claims) == 0:
        return True
    values, noise = claims.values, claims.covariance.reshape(-1, 4)
    doubts, kinds = _doubts(claims).values(), set(claims.kind.tolist())
    if not kinds <= _KINDS:
        return False
    alone = kinds & _ALONE
    if alone:
        absent = ABSENT[claims.kind]
        if np.isnan(values).tobytes() != absent.tobytes():
            return False
        values = np.where(absent, 0.0, values)
    return bool(
        _sum_of_squares(values) < ABSURD_M**2  # and so there is no NaN left
        and (kinds == _POSITIONS or min(values[:, 1].tolist()) >= 0.0)
        and _sum_of_squares(claims.sensor_pose) < ABSURD_M**2
        and _sum_of_squares(noise) < BEARING_VARIANCE_MAX**2
        and noise[:, ::3].min() > VARIANCE_MIN
        and (np.count_nonzero(noise[:, 1:3]) == 0 or _are_definite(noise, bool(alone)).all())
        and not (alone and np.count_nonzero(noise[:, ::3][absent] != 1.0))
        and all(np.count_nonzero(each) == 0 or are_semidefinite(each).all() for each in doubts)
    )


class _Fault(NamedTuple):
    """One thing that may be wrong.

    Attributes:
        rows: Shape (M,), bool: where it is.
        got: What a row holds, in words.
        needed: In words.
        remedy: What to do, a sentence.
    """

    rows: BoolArray
    got: Callable[[int], str]
    needed: str
    remedy: str = "Correct it, or leave such rows out (refuse='drop')."


def _faults(claims: Measurements) -> Iterator[_Fault]:
    """Everything that may be wrong, the simplest first."""
    known = (claims.kind >= 0) & (claims.kind < len(SensorKind))
    names = ", ".join(f"{kind.value} ({kind.name})" for kind in SensorKind)
    yield _Fault(
        ~known,
        lambda row: f"kind {claims.kind[row]}",
        f"a SensorKind: {names}",
        "Use polar, bearings, ranges or cartesian, which set it.",
    )
    kind = np.where(known, claims.kind, SensorKind.POSITION)
    yield from _faults_of_values(claims.values, kind)
    yield from _faults_of_noise(claims.covariance, kind)
    yield from _faults_of_pose(claims)


def _faults_of_values(values: FloatArray, kind: FloatArray) -> Iterator[_Fault]:
    absent, is_nan = ABSENT[kind], np.isnan(values)
    polar, first, second = kind != SensorKind.POSITION, values[:, 0], values[:, 1]
    far = ~(np.abs(values) < ABSURD_M)  # NaN compares as false, and so is far
    yield _Fault(
        polar & is_nan.all(axis=1),
        lambda row: "neither bearing nor range (both are NaN)",
        "at least one of them",
        "Leave such rows out (refuse='drop' does).",
    )
    yield _Fault(
        (absent & ~is_nan).any(axis=1),
        lambda row: f"values {values[row].tolist()} and kind {SensorKind(kind[row]).name}",
        "NaN for the numbers that this kind does not measure",
        "Use polar, which chooses the kind by the NaN values.",
    )
    limit = f"a finite number below {ABSURD_M:g}"
    yield _Fault(
        ~polar & far.any(axis=1),
        lambda row: f"the position {values[row].tolist()} m",
        f"x_m and y_m, each {limit}",
    )
    yield _Fault(
        polar & ~absent[:, 0] & far[:, 0],
        lambda row: f"the bearing {first[row]} rad",
        f"{limit}, or NaN where only the range is known",
    )
    yield _Fault(
        polar & ~absent[:, 1] & (far[:, 1] | (second < 0.0)),
        lambda row: f"the range {second[row]} m",
        f"{limit} and not negative, or NaN where only the bearing is known",
    )


def _faults_of_noise(covariance: FloatArray, kind: FloatArray) -> Iterator[_Fault]:
    variance = np.stack([covariance[:, 0, 0], covariance[:, 1, 1]], axis=-1)
    std = np.sign(variance) * np.sqrt(np.abs(variance))
    absent, polar = ABSENT[kind], kind != SensorKind.POSITION
    most = np.where(polar, BEARING_VARIANCE_MAX, VARIANCE_MAX)
    wrong = ~((variance > VARIANCE_MIN) & (variance < VARIANCE_MAX))
    wrong[:, 0] |= ~(variance[:, 0] < most)
    for column, name, unit, limit in (
        (0, "bearing", "rad", BEARING_VARIANCE_MAX),
        (1, "range", "m", VARIANCE_MAX),
    ):
        yield _Fault(
            polar & ~absent[:, column] & wrong[:, column],
            lambda row, column=column, name=name, unit=unit: (  # type: ignore[misc]
                f"the {name}'s standard deviation {std[row, column]:.6g} {unit}"
            ),
            f"more than {VARIANCE_MIN**0.5:g} and less than {limit**0.5:.6g} {unit}",
            "State the sensor's true noise.",
        )
    wrong |= absent & (variance != 1.0)
    is_definite = _are_definite(covariance.reshape(-1, 4), absent.any(axis=1))
    yield _Fault(
        wrong.any(axis=1) | ~is_definite,
        lambda row: f"the covariance {covariance[row].tolist()}",
        f"a symmetric positive definite matrix, variances between {VARIANCE_MIN:g} and "
        f"{VARIANCE_MAX:g}; 1 and no correlation for numbers that are not measured",
        "State the sensor's true noise.",
    )


def _are_definite(noise: FloatArray, alone: BoolArray | bool) -> BoolArray:
    """Shape (M,): symmetric, with a correlation below 1, and 0 for single numbers.

    The variances are left to others.
    """
    first, mixed, mirrored, second = noise.T
    with np.errstate(invalid="ignore", over="ignore"):
        spread = np.sqrt(first) * np.sqrt(second)  # NaN of negative ones, and so refused
        is_symmetric = np.abs(mixed - mirrored) <= _ROUNDING * spread
        is_below_one = np.abs(mixed) < np.where(alone, 0.0, (1.0 - _ROUNDING) * spread)
    is_diagonal = (mixed == 0.0) & (mirrored == 0.0)
    return np.asarray(is_diagonal | (is_symmetric & is_below_one))


def _faults_of_pose(claims: Measurements) -> Iterator[_Fault]:
    pose = claims.sensor_pose
    yield _Fault(
        np.asarray(~(np.abs(pose) < ABSURD_M).all(axis=1)),
        lambda row: f"the sensor_pose {pose[row].tolist()}",
        f"x_m, y_m and yaw_rad, each a finite number below {ABSURD_M:g}",
    )
    for name, doubt in _doubts(claims).items():
        yield _Fault(
            ~are_semidefinite(doubt),
            lambda row, name=name, doubt=doubt: f"the {name} {doubt[row].tolist()}",  # type: ignore[misc]
            f"a symmetric positive semidefinite matrix of numbers below {VARIANCE_MAX:g}",
            _WITHOUT[name],
        )


def _doubts(claims: Measurements) -> dict[str, FloatArray]:
    """The covariances that may be zero, by name."""
    return {name: getattr(claims, name) for name in _WITHOUT}


def are_semidefinite(covariance: FloatArray) -> BoolArray:
    """Shape (M,): which of the matrices, shape (M, n, n), could be a covariance."""
    finite = np.asarray((np.abs(covariance) < VARIANCE_MAX).all(axis=(1, 2)))
    safe = np.where(finite[:, None, None], covariance, 0.0)
    asymmetry = np.abs(safe - np.swapaxes(safe, 1, 2)).max(axis=(1, 2))
    least, most = _extreme_eigenvalues(safe)
    return np.asarray(finite & (asymmetry <= _ROUNDING * most) & (least >= -_ROUNDING * most))


def _extreme_eigenvalues(symmetric: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Each of shape (M,): the least and the greatest of matrices of shape (M, n, n).

    In closed form for two dimensions, as every frame asks for them.
    """
    if symmetric.shape[1:] != (2, 2):
        values = np.asarray(np.linalg.eigvalsh(symmetric), dtype=np.float64)
        return values[:, 0], values[:, -1]
    first, second, mixed = symmetric[:, 0, 0], symmetric[:, 1, 1], symmetric[:, 1, 0]
    middle, half = (first + second) / 2.0, np.hypot((first - second) / 2.0, mixed)
    return np.asarray(middle - half), np.asarray(middle + half)
