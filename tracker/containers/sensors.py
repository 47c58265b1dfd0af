"""What do the sensors send? Pictures of camera and depth camera, one turn of the LiDAR."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tracker.containers.arrays import BoolArray, FloatArray, ImageArray, check_stamp, frozen
from tracker.errors import ShapeError

#: A turn that claims to last longer has a `time_increment` in another unit.
_TURN_MAX_S = 1.0
#: Meters ahead of the camera, NaN where there is no reading.
DepthArray: TypeAlias = NDArray[np.float32]

#: A reading in whole numbers counts millimeters (REP-118).
_MILLIMETERS = 0.001


@dataclass(frozen=True, slots=True, eq=False)
class CameraImage:
    """One picture of the camera.

    Attributes:
        stamp_ns: When it was taken.
        frame_id: The camera's frame; empty means the configured one.
        bgr: Shape (height, width, 3), uint8, blue-green-red.
        remark: What had to be guessed about its encoding; empty where nothing had to be.

    Raises:
        ShapeError: The array is no BGR picture, or has no pixels.
        ClockError: The stamp is negative.
    """

    stamp_ns: int
    frame_id: str
    bgr: ImageArray
    remark: str = ""

    def __post_init__(self) -> None:
        check_stamp(self.stamp_ns)
        shape = self.bgr.shape
        if len(shape) != 3 or shape[2] != 3 or 0 in shape or self.bgr.dtype != np.uint8:
            raise ShapeError(
                f"An image has shape {shape} and type {self.bgr.dtype}; "
                "expected (height, width, 3) with pixels in it and uint8."
            )

    @property
    def height(self) -> int:
        """Rows of pixels."""
        return int(self.bgr.shape[0])

    @property
    def width(self) -> int:
        """Columns of pixels."""
        return int(self.bgr.shape[1])


@dataclass(frozen=True, slots=True, eq=False)
class Scan:
    """One turn of a planar LiDAR.

    Attributes:
        stamp_ns: When the first beam was measured.
        frame_id: The laser's frame; empty means it coincides with the camera's body frame.
        angle_min_rad: Direction of beam 0, counter-clockwise from the frame's x axis.
        angle_increment_rad: From one beam to the next; negative for scanners that turn clockwise.
        range_min_m: Nearest range that counts.
        range_max_m: Farthest range that counts.
        ranges_m: Shape (B,). What is not above 0 and within the limits is no return; infinite or
            beyond `range_max_m` says that nothing is there, NaN, 0 and less say nothing.
        time_increment_s: From one beam to the next; 0 where the driver does not tell.

    Raises:
        ShapeError: `ranges_m` is not one-dimensional, or the increment is zero or not finite.
        ClockError: The stamp is negative.
    """

    stamp_ns: int
    frame_id: str
    angle_min_rad: float
    angle_increment_rad: float
    range_min_m: float
    range_max_m: float
    ranges_m: FloatArray
    time_increment_s: float = 0.0

    def __post_init__(self) -> None:
        check_stamp(self.stamp_ns)
        object.__setattr__(self, "ranges_m", frozen(self.ranges_m))
        if self.ranges_m.ndim != 1:
            raise ShapeError(f"Scan ranges have shape {self.ranges_m.shape}; expected (B,).")
        if not np.isfinite(self.angle_min_rad):
            raise ShapeError(
                f"A scan starts at {self.angle_min_rad} rad; a finite angle is needed."
            )
        if len(self.ranges_m) and (
            self.angle_increment_rad == 0.0 or not np.isfinite(self.angle_increment_rad)
        ):
            raise ShapeError(
                f"A scan of {len(self.ranges_m)} beams has an angle increment of "
                f"{self.angle_increment_rad} rad; it must be finite and not zero."
            )

    @property
    def valid(self) -> BoolArray:
        """Shape (B,): beams with a return inside the scanner's limits."""
        ranges = self.ranges_m
        inside = (ranges > 0.0) & (ranges >= self.range_min_m) & (ranges <= self.range_max_m)
        return inside & np.isfinite(ranges)

    @property
    def shows_nothing(self) -> BoolArray:
        """Shape (B,): beams that met nothing within the scanner's reach."""
        return np.isposinf(self.ranges_m) | (self.ranges_m > self.range_max_m)

    @property
    def end_ns(self) -> int:
        """When the last beam was measured; the stamp where the driver does not tell."""
        lasts_s = self.time_increment_s * (len(self.ranges_m) - 1)
        is_told = 0.0 < lasts_s < _TURN_MAX_S
        return self.stamp_ns + round(lasts_s * 1e9) if is_told else self.stamp_ns

    @property
    def angles_rad(self) -> FloatArray:
        """Shape (B,): direction of each beam in the laser's frame, not normalized."""
        beams = np.arange(len(self.ranges_m), dtype=np.float64)
        return self.angle_min_rad + self.angle_increment_rad * beams


@dataclass(frozen=True, slots=True, eq=False)
class DepthImage:
    """One picture of a depth camera.

    Depth cameras send more pictures than are processed, and packed ones take longer to unpack than
    to use; so the pixels are read only when they are needed.

    Attributes:
        stamp_ns: When it was taken.
        frame_id: The depth camera's frame; empty means the color camera's.
        read: Gives the pixels, shape (height, width): uint16 in millimeters, 0 for no reading, or
            float32 in meters, not finite or not above 0 for no reading. May raise a TrackerError.

    Raises:
        ClockError: The stamp is negative.
    """

    stamp_ns: int
    frame_id: str
    read: Callable[[], NDArray[Any]]

    def __post_init__(self) -> None:
        check_stamp(self.stamp_ns)

    @staticmethod
    def of(stamp_ns: int, frame_id: str, pixels: NDArray[Any]) -> DepthImage:
        """A picture whose pixels are at hand, as `read` gives them."""
        return DepthImage(stamp_ns, frame_id, lambda: pixels)


def depth_in_meters(pixels: NDArray[Any]) -> DepthArray:
    """The readings of `DepthImage.read`, or of a part of them.

    Args:
        pixels: Shape (height, width), uint16 or float32.

    Returns:
        The same shape, in meters; NaN where there is no reading.

    Raises:
        ShapeError: The array is no depth picture.
    """
    if pixels.ndim != 2 or pixels.dtype not in (np.uint16, np.float32):
        raise ShapeError(
            f"A depth image has shape {pixels.shape} and type {pixels.dtype}; needed are "
            "(height, width) and uint16 (millimeters) or float32 (meters)."
        )
    unit_m = np.float32(_MILLIMETERS if pixels.dtype == np.uint16 else 1.0)
    depth_m: DepthArray = pixels.astype(np.float32) * unit_m
    with np.errstate(invalid="ignore"):
        depth_m[~((depth_m > 0.0) & (depth_m < np.inf))] = np.nan
    return depth_m
