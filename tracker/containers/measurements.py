"""What did the sensors measure of people?"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracker.containers.arrays import (
    COUNTS,
    FLAGS,
    BoolArray,
    FloatArray,
    IntArray,
    constant,
    fill,
    frozen,
    numbers,
    sealed,
)
from tracker.containers.measurement_check import (
    Refuse,
    are_ordinary,
    check_measurements,
    usable_rows,
)
from tracker.containers.rows import Column, Rows, trusted
from tracker.containers.sensor_kind import SensorKind
from tracker.errors import MeasurementError, ShapeError

if TYPE_CHECKING:
    from typing_extensions import Unpack

_ORIGIN = constant(0.0, (3,))
#: Of a bearing and a range: the kind, by whether the bearing and whether the range is NaN.
_KIND_BY_MISSING = np.array(
    [[SensorKind.BEARING_RANGE, SensorKind.BEARING], [SensorKind.RANGE, SensorKind.BEARING]]
)


class _Details(TypedDict, total=False):
    """What `bearings` and `ranges` hand on to `polar`."""

    raised: ArrayLike
    person: ArrayLike
    hand: ArrayLike
    identity: ArrayLike
    sensor_pose_covariance: ArrayLike | None
    bias_covariance: ArrayLike | None
    refuse: Refuse


@dataclass(frozen=True, eq=False)
class Measurements(Rows):
    """What sensors measured of people at one instant; row i of each array is one measurement.

    A tracker can use every row: numbers are finite and below 1e9, covariances are positive
    definite. What cannot be used is refused where it is made.

    Attributes:
        values: Shape (M, 2). Bearing and range: bearing_rad (counter-clockwise in the sensor's
            frame) and range_m, NaN in the place of what the kind does not have. Position: x_m,
            y_m in the fixed frame.
        covariance: Shape (M, 2, 2), in the units of `values`; 1 without correlation in the place
            of what the kind does not have.
        kind: Shape (M,), `SensorKind`.
        sensor_pose: Shape (M, 3): x_m, y_m, yaw_rad of the sensor in the fixed frame.
        raised: Shape (M,), bool: a raised hand is behind it. Only such measurements create
            customers and feed the streaks; others (lowered hands, person clusters of the scan)
            sustain and refine customers that exist.
        person: Shape (M,), int64: claims that share a non-negative number come from the same body
            (the same scan segment) at this instant; negative where nobody knows.
        hand: Shape (M,), int64: row of the image's `Hands`, or -1.
        sensor_pose_covariance: Shape (M, 3, 3), of `sensor_pose`; None means zeros (well known).
        identity: Shape (M,), int64: claims that share a non-negative number come from the same
            person at all times, such as the number of a tag; negative where nobody knows. None
            means -1 everywhere.
        bias_covariance: Shape (M, 2, 2), in the fixed frame, in square meters: of the part of the
            place's error that lasts from image to image, such as the distance between legs and
            torso. It is considered in `Tracks.covariance`, not in the gain, and need not be part
            of `covariance`. None means zeros.

    Raises:
        ShapeError: The arrays disagree in length.
        MeasurementError: A tracker cannot use a row; see `tracker.containers.measurement_check`.
    """

    values: Annotated[FloatArray, Column((2,))]
    covariance: Annotated[FloatArray, Column((2, 2))]
    kind: IntArray
    sensor_pose: Annotated[FloatArray, Column((3,))]
    raised: BoolArray
    person: IntArray
    hand: IntArray
    sensor_pose_covariance: Annotated[FloatArray, Column((3, 3), missing=0.0)] = None  # type: ignore[assignment]
    identity: Annotated[IntArray, Column(missing=-1)] = None  # type: ignore[assignment]
    bias_covariance: Annotated[FloatArray, Column((2, 2), missing=0.0)] = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        super().__post_init__()
        check_measurements(self)

    @staticmethod
    def polar(
        bearing_rad: ArrayLike,
        range_m: ArrayLike,
        bearing_std_rad: ArrayLike,
        range_std_m: ArrayLike,
        sensor_pose: ArrayLike = _ORIGIN,
        *,
        raised: ArrayLike = True,
        person: ArrayLike = -1,
        hand: ArrayLike = -1,
        identity: ArrayLike = -1,
        sensor_pose_covariance: ArrayLike | None = None,
        bias_covariance: ArrayLike | None = None,
        refuse: Refuse = "raise",
    ) -> Measurements:
        """Bearings and ranges seen from a sensor; either may be NaN where it is not known.

        Args:
            bearing_rad: Shape (M,), counter-clockwise from the sensor's x axis; NaN where only the
                range is known.
            range_m: Shape (M,) or one number; NaN where only the bearing is known.
            bearing_std_rad: Shape (M,) or one number; ignored where the bearing is NaN.
            range_std_m: Shape (M,) or one number; ignored where the range is NaN.
            sensor_pose: x_m, y_m, yaw_rad of the sensor in the fixed frame, shape (3,) or (M, 3).
            raised: Shape (M,) or one truth value.
            person: Shape (M,) or one number; see the class.
            hand: Shape (M,) or one number; see the class.
            identity: Shape (M,) or one number; see the class.
            sensor_pose_covariance: Shape (3, 3) or (M, 3, 3); None where the pose is well known.
            bias_covariance: Shape (2, 2) or (M, 2, 2); see the class. None where nothing lasts.
            refuse: What becomes of rows that a tracker cannot use: "raise" an error, or "drop"
                them.

        Raises:
            ShapeError: The arrays disagree in length, or are not numbers.
            MeasurementError: A tracker cannot use a row.
        """
        bearing = numbers("bearing_rad", bearing_rad)
        count = bearing.size
        values, covariance = np.empty((count, 2)), np.zeros((count, 2, 2))
        fill("bearing_rad", values[:, 0], bearing)
        fill("range_m", values[:, 1], range_m)
        fill("bearing_std_rad", covariance[:, 0, 0], bearing_std_rad)
        fill("range_std_m", covariance[:, 1, 1], range_std_m)
        std, poses = covariance.reshape(count, 4)[:, ::3], _poses(sensor_pose, count)
        kind, known = _kinds(values, std)
        is_plain = sensor_pose_covariance is None and bias_covariance is None
        is_ordinary = is_plain and are_ordinary(known, std, poses)
        _square(covariance, is_ordinary)
        claims = trusted(
            Measurements,
            values=sealed(values),
            kind=kind,
            covariance=sealed(covariance),
            sensor_pose=poses,
            raised=_column("raised", raised, count, FLAGS),
            person=_column("person", person, count, COUNTS),
            hand=_column("hand", hand, count, COUNTS),
            sensor_pose_covariance=_matrices("sensor_pose", sensor_pose_covariance, count, 3),
            identity=_column("identity", identity, count, COUNTS),
            bias_covariance=_matrices("bias", bias_covariance, count, 2),
        )
        return _usable(claims, refuse, is_ordinary)

    @staticmethod
    def bearings(
        bearing_rad: ArrayLike,
        bearing_std_rad: ArrayLike,
        sensor_pose: ArrayLike = _ORIGIN,
        **details: Unpack[_Details],
    ) -> Measurements:
        """Bearings alone, as of a camera; `polar` says what the arguments are."""
        return Measurements.polar(
            bearing_rad, np.nan, bearing_std_rad, 1.0, sensor_pose, **details
        )

    @staticmethod
    def ranges(
        range_m: ArrayLike,
        range_std_m: ArrayLike,
        sensor_pose: ArrayLike = _ORIGIN,
        **details: Unpack[_Details],
    ) -> Measurements:
        """Ranges alone, as of an ultrasonic sensor or the anchors of a tag.

        `polar` says what the arguments are.
        """
        distance = numbers("range_m", range_m)
        unknown = np.full(distance.size, np.nan)
        return Measurements.polar(unknown, distance, 1.0, range_std_m, sensor_pose, **details)

    @staticmethod
    def cartesian(
        xy_m: ArrayLike,
        covariance: ArrayLike,
        *,
        raised: ArrayLike = True,
        person: ArrayLike = -1,
        hand: ArrayLike = -1,
        identity: ArrayLike = -1,
        bias_covariance: ArrayLike | None = None,
        refuse: Refuse = "raise",
    ) -> Measurements:
        """Positions in the fixed frame.

        Args:
            xy_m: Shape (M, 2), or (2,) for one.
            covariance: Shape (2, 2) or (M, 2, 2), in square meters.
            raised: Shape (M,) or one truth value.
            person: Shape (M,) or one number; see the class.
            hand: Shape (M,) or one number; see the class.
            identity: Shape (M,) or one number; see the class.
            bias_covariance: As in `polar`.
            refuse: As in `polar`.

        Raises:
            ShapeError: The arrays disagree in length, or are not numbers.
            MeasurementError: A tracker cannot use a row.
        """
        xy = numbers("xy_m", xy_m)
        if xy.ndim == 1 and xy.size in (0, 2):
            xy = xy.reshape(-1, 2)
        if xy.ndim != 2 or xy.shape[1] != 2:
            raise ShapeError(f"`xy_m` has shape {xy.shape}; expected (M, 2), a row for each.")
        count = len(xy)
        spread = np.empty((count, 2, 2))
        fill("covariance", spread, covariance)
        claims = trusted(
            Measurements,
            values=frozen(xy),
            covariance=sealed(spread),
            kind=constant(SensorKind.POSITION, (count,), COUNTS),
            sensor_pose=constant(0.0, (count, 3)),
            raised=_column("raised", raised, count, FLAGS),
            person=_column("person", person, count, COUNTS),
            hand=_column("hand", hand, count, COUNTS),
            sensor_pose_covariance=constant(0.0, (count, 3, 3)),
            identity=_column("identity", identity, count, COUNTS),
            bias_covariance=_matrices("bias", bias_covariance, count, 2),
        )
        return _usable(claims, refuse)


def _usable(claims: Measurements, refuse: Refuse, is_ordinary: bool = False) -> Measurements:
    """The rows that a tracker can use; all of them where nothing needs a closer look."""
    if refuse not in ("raise", "drop"):
        raise MeasurementError(f"`refuse` is {refuse!r}; expected 'raise' or 'drop'.")
    if is_ordinary:
        return claims
    if refuse == "drop":
        usable = usable_rows(claims)
        return claims if usable.all() else claims[usable]
    check_measurements(claims)
    return claims


def _kinds(values: FloatArray, std: FloatArray) -> tuple[IntArray, FloatArray]:
    """Kinds of bearings and ranges by what is NaN, and the numbers with 1 there, as in `std`."""
    count, missing = len(values), np.isnan(values)
    pattern = missing.tobytes()  # quicker than to reduce an array of a few rows
    if 1 not in pattern:
        return constant(SensorKind.BEARING_RANGE, (count,), COUNTS), values
    known = values.copy()
    if pattern == b"\0\1" * count:
        known[:, 1] = std[:, 1] = 1.0
        return constant(SensorKind.BEARING, (count,), COUNTS), known
    no_bearing, no_range = missing.T
    no_bearing &= ~no_range  # a row that has neither keeps its NaN, and is refused
    np.copyto(known, 1.0, where=missing)
    np.copyto(std, 1.0, where=missing)
    kind = _KIND_BY_MISSING[no_bearing.view(np.uint8), no_range.view(np.uint8)]
    return sealed(kind), known


def _square(std: FloatArray, is_ordinary: bool) -> None:
    """Turn standard deviations into variances; the sign of bad ones stays, for the check."""
    if is_ordinary:
        std *= std
    else:
        with np.errstate(over="ignore"):  # an infinite variance is refused as well
            std *= np.abs(std)


def _poses(sensor_pose: ArrayLike, count: int) -> FloatArray:
    if sensor_pose is _ORIGIN:
        return constant(0.0, (count, 3))
    poses = np.empty((count, 3))
    fill("sensor_pose", poses, sensor_pose)
    return sealed(poses)


def _matrices(name: str, covariance: ArrayLike | None, count: int, size: int) -> FloatArray:
    if covariance is None:
        return constant(0.0, (count, size, size))
    matrices = np.empty((count, size, size))
    fill(f"{name}_covariance", matrices, covariance)
    return sealed(matrices)


def _column(name: str, value: ArrayLike, count: int, dtype: np.dtype[Any]) -> NDArray[Any]:
    if isinstance(value, (bool, int)) and -1 <= value < 2**63:
        return constant(value, (count,), dtype)
    column = np.empty(count, dtype)
    fill(name, column, _whole(name, value) if dtype == COUNTS else value)
    return sealed(column)


def _whole(name: str, value: ArrayLike) -> ArrayLike:
    if isinstance(value, np.ndarray) and value.dtype.kind in "bi":
        return value
    number = numbers(name, value)
    if not ((number == np.floor(number)) & (np.abs(number) < 2.0**63)).all():
        raise MeasurementError(
            f"`{name}` is {value!r}; expected whole numbers below 2^63, -1 if it is unknown."
        )
    return value
