"""What do the sensors claim about people?"""

from __future__ import annotations

from dataclasses import dataclass, fields
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracker.containers.arrays import (
    COUNTS,
    FLAGS,
    NUMBERS,
    BoolArray,
    FloatArray,
    IntArray,
    check_rows,
    constant,
    fill,
    sealed,
    select,
    trusted,
)

_LAYOUT = {
    "values": (NUMBERS, (2,)),
    "covariance": (NUMBERS, (2, 2)),
    "model": (COUNTS, ()),
    "sensor_pose": (NUMBERS, (3,)),
    "raised": (FLAGS, ()),
    "person": (COUNTS, ()),
    "hand": (COUNTS, ()),
    "sensor_pose_covariance": (NUMBERS, (3, 3)),
}
_ORIGIN = constant(0.0, (3,))


class MeasurementModel(IntEnum):
    """How a measurement's two numbers are read."""

    POLAR = 0
    CARTESIAN = 1


@dataclass(frozen=True, eq=False)
class Measurements:
    """What the sensors claim about people at one instant; row i of each array is one claim.

    Attributes:
        values: Shape (M, 2). Polar: bearing_rad (counter-clockwise in the sensor's frame) and
            range_m, where a NaN range means "bearing only". Cartesian: x_m, y_m in the fixed
            frame.
        covariance: Shape (M, 2, 2), in the units of `values`.
        model: Shape (M,), `MeasurementModel`.
        sensor_pose: Shape (M, 3): x_m, y_m, yaw_rad of the sensor in the fixed frame.
        raised: Shape (M,), bool: a raised hand is behind it. Only such measurements create
            customers and feed the streaks; others (lowered hands, person clusters of the scan)
            sustain and refine customers that exist.
        person: Shape (M,), int64: claims that share a non-negative number come from the same body
            (the same scan segment); -1 where nobody knows.
        hand: Shape (M,), int64: row of the image's `Hands`, or -1.
        sensor_pose_covariance: Shape (M, 3, 3), of `sensor_pose`; None means zeros (well known).
    """

    values: FloatArray
    covariance: FloatArray
    model: IntArray
    sensor_pose: FloatArray
    raised: BoolArray
    person: IntArray
    hand: IntArray
    sensor_pose_covariance: FloatArray = None  # type: ignore[assignment]  # zeros take its place

    def __post_init__(self) -> None:
        count = len(self.values)
        if self.sensor_pose_covariance is None:
            object.__setattr__(self, "sensor_pose_covariance", constant(0.0, (count, 3, 3)))
        check_rows(self, count, _LAYOUT)

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, rows: Any) -> Measurements:
        return select(self, rows)

    @staticmethod
    def none() -> Measurements:
        """No measurement at all."""
        return Measurements.cartesian(np.zeros((0, 2)), np.zeros((0, 2, 2)))

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
    ) -> Measurements:
        """Bearings and ranges seen from a sensor.

        Args:
            bearing_rad: Shape (M,), counter-clockwise from the sensor's x axis.
            range_m: Shape (M,) or one number; NaN where only the bearing is known.
            bearing_std_rad: Shape (M,) or one number.
            range_std_m: Shape (M,) or one number; ignored where the range is NaN.
            sensor_pose: x_m, y_m, yaw_rad of the sensor in the fixed frame, shape (3,) or (M, 3).
            raised: Shape (M,) or one truth value.
            person: Shape (M,) or one number; see the class.
            hand: Shape (M,) or one number; see the class.

        Raises:
            ShapeError: The arrays disagree in length.
        """
        bearing = np.asarray(bearing_rad, dtype=np.float64)
        count = bearing.size
        values, covariance = np.empty((count, 2)), np.zeros((count, 2, 2))
        distance, spread = values[:, 1], covariance[:, 1, 1]
        fill("bearing_rad", values[:, 0], bearing)
        fill("range_m", distance, range_m)
        fill("bearing_std_rad", covariance[:, 0, 0], bearing_std_rad)
        fill("range_std_m", spread, range_std_m)
        with np.errstate(over="ignore"):  # an infinite variance says nothing, and is passed over
            covariance *= covariance
        np.copyto(spread, 1.0, where=np.isnan(distance))
        return trusted(
            Measurements,
            values=sealed(values),
            covariance=sealed(covariance),
            model=constant(MeasurementModel.POLAR, (count,), COUNTS),
            sensor_pose=_poses(sensor_pose, count),
            raised=_column("raised", raised, count, FLAGS),
            person=_column("person", person, count, COUNTS),
            hand=_column("hand", hand, count, COUNTS),
            sensor_pose_covariance=constant(0.0, (count, 3, 3)),
        )

    @staticmethod
    def cartesian(
        xy_m: ArrayLike,
        covariance: ArrayLike,
        *,
        raised: ArrayLike = True,
        person: ArrayLike = -1,
        hand: ArrayLike = -1,
    ) -> Measurements:
        """Positions in the fixed frame.

        Args:
            xy_m: Shape (M, 2).
            covariance: Shape (2, 2) or (M, 2, 2), in square meters.
            raised: Shape (M,) or one truth value.
            person: Shape (M,) or one number; see the class.
            hand: Shape (M,) or one number; see the class.

        Raises:
            ShapeError: The arrays disagree in length.
        """
        xy = np.asarray(xy_m, dtype=np.float64)
        xy = xy[None, :] if xy.ndim == 1 else xy
        count = len(xy)
        spread = np.empty((count, 2, 2))
        fill("covariance", spread, covariance)
        return Measurements(
            values=xy,
            covariance=spread,
            model=constant(MeasurementModel.CARTESIAN, (count,), COUNTS),
            sensor_pose=constant(0.0, (count, 3)),
            raised=_column("raised", raised, count, FLAGS),
            person=_column("person", person, count, COUNTS),
            hand=_column("hand", hand, count, COUNTS),
        )

    @staticmethod
    def concatenate(*parts: Measurements) -> Measurements:
        """Join batches of one instant, rows in the order given."""
        joined = {
            item.name: np.concatenate([getattr(part, item.name) for part in parts])
            for item in fields(Measurements)
        }
        return Measurements(**joined)


def _poses(sensor_pose: ArrayLike, count: int) -> FloatArray:
    if sensor_pose is _ORIGIN:
        return constant(0.0, (count, 3))
    poses = np.empty((count, 3))
    fill("sensor_pose", poses, sensor_pose)
    return sealed(poses)


def _column(name: str, value: ArrayLike, count: int, dtype: np.dtype[Any]) -> NDArray[Any]:
    if isinstance(value, (bool, int)):
        return constant(value, (count,), dtype)
    column = np.empty(count, dtype)
    fill(name, column, value)
    return sealed(column)
