"""How does a lens bend light? Distortion models, from the image plane to rays and back."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import cached_property, lru_cache

import numpy as np

from tracker.containers import FloatArray
from tracker.errors import ConfigError


class LensKind(Enum):
    """How the distance from the picture's principal point grows with the angle off the axis."""

    STRAIGHT = "tan(angle)"
    POLYNOMIAL = "tan(angle), bent by OpenCV's polynomials"
    FISHEYE = "the angle itself, bent by a polynomial"


#: Distortion models by the names that drivers give them, in small letters with underscores. First
#: those of sensor_msgs/CameraInfo.
DISTORTION_MODELS = {
    "plumb_bob": LensKind.POLYNOMIAL,
    "rational_polynomial": LensKind.POLYNOMIAL,
    "equidistant": LensKind.FISHEYE,
    "thin_prism": LensKind.POLYNOMIAL,
    "brown_conrady": LensKind.POLYNOMIAL,
    "radtan": LensKind.POLYNOMIAL,
    "radial_tangential": LensKind.POLYNOMIAL,
    "fisheye": LensKind.FISHEYE,
    "kannala_brandt": LensKind.FISHEYE,
    "kannala_brandt4": LensKind.FISHEYE,
    "": LensKind.STRAIGHT,
    "none": LensKind.STRAIGHT,
    "pinhole": LensKind.STRAIGHT,
    # Librealsense's names. Its cameras send zeros with them; anything else is another lens.
    "inverse_brown_conrady": LensKind.STRAIGHT,
    "modified_brown_conrady": LensKind.STRAIGHT,
}

#: Numbers of coefficients each kind is defined for. A longer list must end in zeros.
_COUNTS = {
    LensKind.STRAIGHT: (0,),
    LensKind.POLYNOMIAL: (0, 4, 5, 8, 12, 14),
    LensKind.FISHEYE: (0, 4),
}

#: Angles off the axis at which a lens is tabulated; a straight lens sees less than a quarter turn.
_TABLE_STEPS = 4096
_STRAIGHT_MAX_RAD, _FISHEYE_MAX_RAD = np.deg2rad(89.0), np.pi
#: Newton's steps from the table's value, and how well the point they find must fit.
_NEWTON_STEPS, _FIT = 6, 1e-6


@dataclass(frozen=True)
class Lens:
    """One lens: its kind and its coefficients.

    Points of the image plane are pixels after the intrinsics are taken off: column and row from
    the principal point, in focal lengths. Directions are of the optical frame (x right, y down, z
    ahead).

    Attributes:
        kind: The formula.
        coefficients: In OpenCV's order, of a length that OpenCV knows.
    """

    kind: LensKind
    coefficients: tuple[float, ...] = ()

    def directions(self, points: FloatArray) -> FloatArray:
        """Where points of the image plane look.

        Args:
            points: Shape (N, 2).

        Returns:
            Shape (N, 3), of length 1; NaN where no light of this lens arrives: beyond the angle
            at which its polynomial turns back.
        """
        if self.kind is LensKind.FISHEYE:
            return self._fisheye_directions(points)
        if not self.coefficients or not len(points):
            return _unit(np.column_stack([points, np.ones(len(points))]))
        return _unit(np.column_stack([self._straighten(points), np.ones(len(points))]))

    def points(self, directions: FloatArray) -> FloatArray:
        """Where directions appear in the image plane: the inverse of `directions`.

        Args:
            directions: Shape (N, 3), of any length.

        Returns:
            Shape (N, 2); NaN where the lens does not see.
        """
        x, y, ahead = np.asarray(directions, dtype=np.float64).reshape(-1, 3).T
        aside = np.hypot(x, y)
        off_axis_rad = np.arctan2(aside, ahead)
        if self.kind is LensKind.FISHEYE:
            scale = self._radii(off_axis_rad) / np.maximum(aside, 1e-12)
            found = np.column_stack([x * scale, y * scale])
        else:
            found = self._bend(np.column_stack([x, y]) / np.maximum(ahead, 1e-12)[:, None])
        found[off_axis_rad > self.max_off_axis_rad] = np.nan
        return found

    @property
    def max_off_axis_rad(self) -> float:
        """The angle up to which the model holds; there its polynomial turns back, if it does."""
        return float(self._table[0][-1])

    @cached_property
    def _table(self) -> tuple[FloatArray, FloatArray]:
        """Angles off the axis, and the radii at which they appear: both grow."""
        most = _FISHEYE_MAX_RAD if self.kind is LensKind.FISHEYE else _STRAIGHT_MAX_RAD
        angles = np.linspace(0.0, most, _TABLE_STEPS)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            radii = self._radii(angles)
        grows = np.append(True, np.diff(radii) > 0.0)  # false where NaN
        end = len(angles) if grows.all() else int(np.argmin(grows))
        return angles[:end], radii[:end]

    def _radii(self, off_axis_rad: FloatArray) -> FloatArray:
        """Distance from the principal point by the radial terms alone."""
        if self.kind is LensKind.FISHEYE:
            squared = off_axis_rad**2
            k1, k2, k3, k4 = self.coefficients or (0.0,) * 4
            bent = 1.0 + squared * (k1 + squared * (k2 + squared * (k3 + squared * k4)))
            return np.asarray(off_axis_rad * bent)
        straight = np.tan(off_axis_rad)
        squared = straight**2
        k = (*self.coefficients, *(0.0,) * 8)[:8]
        above = 1.0 + squared * (k[0] + squared * (k[1] + squared * k[4]))
        below = 1.0 + squared * (k[5] + squared * (k[6] + squared * k[7]))
        return np.asarray(np.where(below > 0.0, straight * above / below, np.nan))

    def _fisheye_directions(self, points: FloatArray) -> FloatArray:
        radius = np.hypot(points[:, 0], points[:, 1])
        angles, radii = self._table
        off_axis_rad = np.interp(radius, radii, angles, right=np.nan)
        for _ in range(_NEWTON_STEPS):
            step = 1e-6
            slope = (self._radii(off_axis_rad + step) - self._radii(off_axis_rad - step)) / (
                2 * step
            )
            better = off_axis_rad - (self._radii(off_axis_rad) - radius) / slope
            off_axis_rad = np.where(slope > 1e-3, np.clip(better, 0.0, angles[-1]), off_axis_rad)
        scale = np.sin(off_axis_rad) / np.maximum(radius, 1e-12)
        return np.column_stack([points * scale[:, None], np.cos(off_axis_rad)])

    def _straighten(self, points: FloatArray) -> FloatArray:
        """Invert `_bend` by Newton's method; NaN where no solution is on the rising branch."""
        angles, radii = self._table
        radius = np.hypot(points[:, 0], points[:, 1])
        start = np.tan(np.interp(radius, radii, angles)) / np.maximum(radius, 1e-12)
        found = points * start[:, None]
        step, to_right, to_bottom = 1e-6, np.array([1e-6, 0.0]), np.array([0.0, 1e-6])
        for _ in range(_NEWTON_STEPS):
            off = self._bend(found) - points
            across = (self._bend(found + to_right) - off - points) / step
            down = (self._bend(found + to_bottom) - off - points) / step
            area = across[:, 0] * down[:, 1] - across[:, 1] * down[:, 0]
            area = np.where(np.abs(area) > 1e-9, area, np.inf)  # no step where it turns back
            found = found - np.column_stack(
                [
                    (off[:, 0] * down[:, 1] - off[:, 1] * down[:, 0]) / area,
                    (across[:, 0] * off[:, 1] - across[:, 1] * off[:, 0]) / area,
                ]
            )
        fits = np.linalg.norm(self._bend(found) - points, axis=-1) <= _FIT
        holds = np.linalg.norm(found, axis=-1) <= np.tan(self.max_off_axis_rad)
        return np.where((fits & holds)[:, None], found, np.nan)

    def _bend(self, points: FloatArray) -> FloatArray:
        """Ideal points of the image plane, as the lens shows them."""
        if not self.coefficients or not len(points):
            return points
        import cv2  # only a distorted camera needs it

        ahead, none = np.column_stack([points, np.ones(len(points))]), np.zeros(3)
        bent, _ = cv2.projectPoints(ahead, none, none, np.eye(3), np.array(self.coefficients))
        return np.asarray(bent, dtype=np.float64).reshape(-1, 2)


@lru_cache(maxsize=32)
def lens_of(model: str, coefficients: tuple[float, ...]) -> Lens:
    """The lens that a driver describes.

    Args:
        model: A name out of `DISTORTION_MODELS`; capitals, blanks and hyphens do not matter.
        coefficients: Of any length that the model knows, or longer by zeros.

    Raises:
        ConfigError: The model is unknown, or has no such number of coefficients.
    """
    name = "_".join(model.lower().replace("-", " ").split())
    kind = DISTORTION_MODELS.get(name)
    known = ", ".join(word for word in DISTORTION_MODELS if word)
    if kind is None:
        raise ConfigError(
            f"Distortion model {model!r} with {len(coefficients)} coefficients came; known are "
            f"{known}. Use rectified pictures, or set use_camera_info: false."
        )
    count = max(count for count in _COUNTS[kind] if count <= len(coefficients))
    if any(coefficients[count:]):
        counts = " or ".join(str(count) for count in _COUNTS[kind])
        raise ConfigError(
            f"Distortion model {model!r} with {len(coefficients)} coefficients came; it is "
            f"defined for {counts}. Known models are {known}."
        )
    kept = coefficients[:count]
    if not any(kept):
        kept = ()
        kind = LensKind.STRAIGHT if kind is LensKind.POLYNOMIAL else kind
    return Lens(kind, kept)


def _unit(directions: FloatArray) -> FloatArray:
    return np.asarray(directions / np.linalg.norm(directions, axis=-1, keepdims=True))
