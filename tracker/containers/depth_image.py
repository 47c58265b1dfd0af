"""What does a depth camera send? How far ahead each pixel's surface is, unpacked when needed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tracker.containers.arrays import check_stamp
from tracker.errors import ShapeError

#: Meters ahead of the camera, NaN where there is no reading.
DepthArray: TypeAlias = NDArray[np.float32]

#: A reading in whole numbers counts millimeters (REP-118).
_MILLIMETERS = 0.001


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
        """A depth image whose pixels are already decoded, in the form of `read`."""
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
            f"A depth image has shape {pixels.shape} and type {pixels.dtype}; expected "
            "(height, width) and uint16 (millimeters) or float32 (meters)."
        )
    unit_m = np.float32(_MILLIMETERS if pixels.dtype == np.uint16 else 1.0)
    depth_m: DepthArray = pixels.astype(np.float32) * unit_m
    with np.errstate(invalid="ignore"):
        depth_m[~((depth_m > 0.0) & (depth_m < np.inf))] = np.nan
    return depth_m
