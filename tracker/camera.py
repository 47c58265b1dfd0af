"""Which ray does a pixel see? Intrinsics, the picture size they belong to, and the lens."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tracker.containers import FloatArray
from tracker.errors import ConfigError
from tracker.geometry import BODY_FROM_OPTICAL
from tracker.lens import Lens, lens_of

#: Sizes of the same shape differ by less than this share; a driver pads or rounds a row or two.
_SHAPE_SHARE = 0.01
#: A principal point lies within this share of the width and of the height from the middle. Guess:
#: calibrated cameras in the field keep within 0.06; the intrinsics of a picture 1.25 times as
#: large are 0.1 off.
_OFF_MIDDLE_SHARE = 0.08
#: Points between the principal point and the picture's edge that are asked where they look.


class Sensor(NamedTuple):
    """The whole picture of the sensor, in pixels of the one that is cut from it."""

    left_px: float
    top_px: float
    width_px: float
    height_px: float


class Pinhole(NamedTuple):
    """Intrinsics of a picture whose distortion has been taken out."""

    fx: float
    fy: float
    cx: float
    cy: float


@dataclass(frozen=True, slots=True)
class DepthCamera:
    """The intrinsics of a depth camera, which must not be taken for the color camera's."""

    camera: CameraModel


@dataclass(frozen=True, slots=True)
class CameraModel:
    """Intrinsics of pictures of one size.

    Attributes:
        fx: Focal length along the columns, pixels.
        fy: Focal length along the rows, pixels.
        cx: Column of the principal point, pixels.
        cy: Row of the principal point, pixels.
        distortion: Coefficients in OpenCV's order; empty for a lens without distortion.
        distortion_model: A name out of `lens.DISTORTION_MODELS`, in any spelling.
        width: Columns of the picture they belong to; None where nobody knows.
        height: Its rows; None where nobody knows.
        sensor: Where the picture is a region of the sensor's, that whole picture.
        rectified: The intrinsics of the picture once it is rectified; None where nobody knows.

    Raises:
        ConfigError: A focal length is not positive, a number not finite, the distortion unknown.
    """

    fx: float
    fy: float
    cx: float
    cy: float
    distortion: tuple[float, ...] = ()
    distortion_model: str = ""
    width: int | None = None
    height: int | None = None
    sensor: Sensor | None = None
    rectified: Pinhole | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        numbers = (self.fx, self.fy, self.cx, self.cy, *self.distortion)
        if not np.all(np.isfinite(numbers)) or self.fx <= 0 or self.fy <= 0:
            raise ConfigError(
                f"Camera intrinsics fx {self.fx}, fy {self.fy}, cx {self.cx}, cy {self.cy}, "
                f"distortion {list(self.distortion)} are invalid; expected finite numbers and "
                "positive focal lengths. An uncalibrated camera "
                "sends zeros: calibrate it, or set use_camera_info: false."
            )
        self.lens  # noqa: B018  # an unknown one is refused here, not at the first picture

    @property
    def lens(self) -> Lens:
        """What bends the light."""
        return lens_of(self.distortion_model, self.distortion)

    def for_picture(self, width: int, height: int) -> CameraModel:
        """The intrinsics of a picture of another size, which shows the same.

        Args:
            width: Columns of the picture.
            height: Rows of the picture.

        Raises:
            ConfigError: The picture has another shape, or is larger than the region of the
                sensor that it should be; nobody can tell what it shows.
        """
        if self.width is None or self.height is None:
            return replace(self, width=width, height=height)
        if (self.width, self.height) == (width, height):
            return self
        across, down = width / self.width, height / self.height
        is_larger_than_region = self.sensor is not None and across > 1.0
        if abs(across / down - 1.0) > _SHAPE_SHARE or is_larger_than_region:
            what = "a region of interest" if self.sensor is not None else "pictures"
            raise ConfigError(
                f"Intrinsics of {what} of {self.width}x{self.height} came with a picture of "
                f"{width}x{height}, which is not a scaled copy; expected the intrinsics of that "
                "size. Correct the driver's CameraInfo (width, height, binning, roi), or set "
                "use_camera_info: false and camera_fx, camera_fy, camera_cx, camera_cy, "
                "camera_width, camera_height."
            )
        return self.scaled(across, down, width, height)

    def scaled(self, across: float, down: float, width: int, height: int) -> CameraModel:
        """The intrinsics of the same view, shown with other pixels.

        Args:
            across: New columns of one old column.
            down: New rows of one old row.
            width: Columns of the new picture.
            height: Rows of the new picture.
        """
        sensor = self.sensor
        if sensor is not None:
            left, top, wide, high = sensor
            sensor = Sensor(left * across, top * down, wide * across, high * down)
        return replace(
            self,
            fx=self.fx * across,
            fy=self.fy * down,
            cx=self.cx * across,
            cy=self.cy * down,
            width=width,
            height=height,
            sensor=sensor,
            rectified=None,
        )

    def for_rectified(self) -> CameraModel:
        """The intrinsics of the same picture after image_proc has taken its distortion out.

        Raises:
            ConfigError: Nobody knows them.
        """
        if self.rectified is None:
            raise ConfigError(
                "The CameraInfo has no P, which says how images are rectified. Calibrate the "
                "camera, or set image_form: raw."
            )
        return CameraModel(
            *self.rectified, width=self.width, height=self.height, sensor=self.sensor
        )

    @property
    def middle_px(self) -> tuple[float, float]:
        """Column and row of the middle of what the whole sensor shows; NaN where nobody knows."""
        left, top, width, height = self._whole
        return left + width / 2, top + height / 2

    @property
    def is_centered(self) -> bool:
        """Whether the principal point lies near the middle, as lenses are mounted.

        It does not where the intrinsics belong to pictures of another size than they claim.
        """
        (column, row), whole = self.middle_px, self._whole
        is_off = (
            abs(self.cx - column) > _OFF_MIDDLE_SHARE * whole.width_px
            or abs(self.cy - row) > _OFF_MIDDLE_SHARE * whole.height_px
        )
        return not is_off

    @property
    def _whole(self) -> Sensor:
        if self.sensor is not None:
            return self.sensor
        return Sensor(0.0, 0.0, self.width or np.nan, self.height or np.nan)

    def rays(self, pixels: ArrayLike) -> FloatArray:
        """Unit vectors along which pixels look, in the camera's body frame (x forward).

        Args:
            pixels: Shape (N, 2): column and row in the picture.

        Returns:
            Shape (N, 3); NaN where the pixel lies beyond the lens's range.
        """
        points = np.asarray(pixels, dtype=np.float64).reshape(-1, 2)
        points = (points - [self.cx, self.cy]) / [self.fx, self.fy]
        return np.asarray(self.lens.directions(points) @ BODY_FROM_OPTICAL.T)

    def pixels(self, rays: ArrayLike) -> FloatArray:
        """Where rays of the camera's body frame (x forward) appear: the inverse of `rays`.

        Args:
            rays: Shape (N, 3), of any length.

        Returns:
            Shape (N, 2): column and row, within the picture or not; NaN beyond the lens's range.
        """
        optical = np.asarray(rays, dtype=np.float64).reshape(-1, 3) @ BODY_FROM_OPTICAL
        points = self.lens.points(optical)
        return np.asarray(points * [self.fx, self.fy] + [self.cx, self.cy])
