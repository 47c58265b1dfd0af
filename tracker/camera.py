"""Which ray does a pixel see? The pinhole camera with its distortion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tracker.containers import FloatArray
from tracker.errors import ConfigError
from tracker.geometry import BODY_FROM_OPTICAL

#: Coefficients each distortion model carries, by the names of sensor_msgs/CameraInfo.
DISTORTION_MODELS = {
    "": (0,),
    "plumb_bob": (0, 4, 5),
    "rational_polynomial": (0, 8),
    "equidistant": (0, 4),
}


@dataclass(frozen=True, slots=True)
class CameraModel:
    """Intrinsics of the full-size image.

    Attributes:
        fx: Focal length along the columns, pixels.
        fy: Focal length along the rows, pixels.
        cx: Column of the principal point, pixels.
        cy: Row of the principal point, pixels.
        distortion: Coefficients in OpenCV's order; empty for a picture without distortion.
        distortion_model: One of `DISTORTION_MODELS`.

    Raises:
        ConfigError: A focal length is not positive, a number not finite, the distortion unknown.
    """

    fx: float
    fy: float
    cx: float
    cy: float
    distortion: tuple[float, ...] = ()
    distortion_model: str = ""

    def __post_init__(self) -> None:
        numbers = (self.fx, self.fy, self.cx, self.cy, *self.distortion)
        if not np.all(np.isfinite(numbers)) or self.fx <= 0 or self.fy <= 0:
            raise ConfigError(
                f"Camera intrinsics fx {self.fx}, fy {self.fy}, cx {self.cx}, cy {self.cy} came; "
                "needed are finite numbers and positive focal lengths. An uncalibrated camera "
                "sends zeros: calibrate it, or set use_camera_info: false."
            )
        allowed = DISTORTION_MODELS.get(self.distortion_model)
        if allowed is None or (any(self.distortion) and len(self.distortion) not in allowed):
            raise ConfigError(
                f"Distortion model {self.distortion_model!r} with {len(self.distortion)} "
                f"coefficients came; known are {', '.join(filter(None, DISTORTION_MODELS))}."
            )

    def undistort(self, pixels: ArrayLike) -> FloatArray:
        """Pixels as an ideal pinhole camera with the same intrinsics would see them.

        Args:
            pixels: Shape (N, 2): column and row in the full image.

        Returns:
            Shape (N, 2).
        """
        points = np.asarray(pixels, dtype=np.float64).reshape(-1, 2)
        if not any(self.distortion) or len(points) == 0:
            return points
        import cv2  # only a distorted camera needs it

        matrix = np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])
        coefficients = np.array(self.distortion)
        lens = cv2.fisheye if self.distortion_model == "equidistant" else cv2
        ideal = lens.undistortPoints(points[:, None, :], matrix, coefficients, P=matrix)
        return np.asarray(ideal, dtype=np.float64).reshape(-1, 2)

    def horizontal_span_rad(self, width_px: int) -> tuple[float, float]:
        """Bearings of the picture's right and left edge, distortion aside.

        Args:
            width_px: Of the full image.

        Returns:
            Counter-clockwise from the optical axis: the right edge's, then the left edge's.
        """
        return (
            -float(np.arctan((width_px - self.cx) / self.fx)),
            float(np.arctan(self.cx / self.fx)),
        )

    def rays(self, pixels: ArrayLike) -> FloatArray:
        """Unit vectors along which pixels look, in the camera's body frame (x forward).

        Args:
            pixels: Shape (N, 2): column and row in the full image.

        Returns:
            Shape (N, 3).
        """
        ideal = self.undistort(pixels)
        optical = np.stack(
            [
                (ideal[:, 0] - self.cx) / self.fx,
                (ideal[:, 1] - self.cy) / self.fy,
                np.ones(len(ideal)),
            ],
            axis=-1,
        )
        body = optical @ BODY_FROM_OPTICAL.T
        return np.asarray(body / np.linalg.norm(body, axis=-1, keepdims=True))
