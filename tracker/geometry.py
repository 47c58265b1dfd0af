"""Where is the hand, seen from the camera, and how do frames chain? Equations 1-12 in one place.

The equation numbers are those of the specification of the original node. Frames follow REP-103:
x forward, y left, z up; optical frames are z forward, x right, y down. Rotations are quaternions
in the order x, y, z, w.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tracker.containers import FloatArray

#: Rotation that takes a vector of an optical frame (z forward, x right, y down) to its body frame.
BODY_FROM_OPTICAL = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])


def camera_angle(px: ArrayLike, cx: float, fx: float) -> FloatArray:
    """Angle of a pixel from the optical axis, positive to the right (equation 1).

    Args:
        px: Pixel column, any shape.
        cx: Column of the principal point, in the same (possibly downscaled) image.
        fx: Focal length in pixels of the same image.
    """
    return np.arctan((np.asarray(px, dtype=np.float64) - cx) / fx)


def polar_to_cartesian(range_m: ArrayLike, angle_rad: ArrayLike) -> FloatArray:
    """Point at a range along an angle, x and y in the last axis (equations 2 and 3; z is 0, 4)."""
    range_, angle = np.asarray(range_m, np.float64), np.asarray(angle_rad, np.float64)
    return np.stack([range_ * np.cos(angle), range_ * np.sin(angle)], axis=-1)


def facing_yaw(x_m: float, y_m: float) -> float:
    """Yaw of somebody at (x, y) who faces the origin (equation 5), in (0, 2 pi]."""
    return float(np.arctan2(y_m, x_m) + np.pi)


def euler_to_quaternion(
    roll_rad: float, pitch_rad: float, yaw_rad: float
) -> tuple[float, float, float, float]:
    """Quaternion x, y, z, w of a ZYX rotation (equations 6 to 10)."""
    cr, sr = np.cos(roll_rad / 2), np.sin(roll_rad / 2)
    cp, sp = np.cos(pitch_rad / 2), np.sin(pitch_rad / 2)
    cy, sy = np.cos(yaw_rad / 2), np.sin(yaw_rad / 2)
    return (
        float(sr * cp * cy - cr * sp * sy),
        float(cr * sp * cy + sr * cp * sy),
        float(cr * cp * sy - sr * sp * cy),
        float(cr * cp * cy + sr * sp * sy),
    )


def scan_index(angle_rad: float, angle_min_rad: float, angle_increment_rad: float) -> int:
    """Beam that looks along an angle (equation 11: the quotient, rounded down)."""
    return int(np.floor((angle_rad - angle_min_rad) / angle_increment_rad))


def normalize_angle(angle_rad: ArrayLike) -> FloatArray:
    """The same direction in [-pi, pi) (equation 12)."""
    angle = np.asarray(angle_rad, dtype=np.float64)
    return angle - 2 * np.pi * np.floor((angle + np.pi) / (2 * np.pi))


def rotation_matrix(quaternion_xyzw: ArrayLike) -> FloatArray:
    """Shape (3, 3) rotation matrix of a unit quaternion."""
    x, y, z, w = np.asarray(quaternion_xyzw, dtype=np.float64)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def worst_std(covariance: FloatArray) -> FloatArray:
    """Standard deviation along the worst axis of covariances.

    Args:
        covariance: Shape (..., 2, 2).

    Returns:
        Shape (...), in the root of their unit.
    """
    return np.asarray(np.sqrt(np.maximum(np.linalg.eigvalsh(covariance)[..., -1], 0.0)))


@dataclass(frozen=True, slots=True)
class RigidTransform:
    """Takes points of one frame to another: `point_map = map_from_camera.apply(point_camera)`.

    Plain floats, because one lookup of three hops in NumPy costs thirty times as much.

    Attributes:
        translation_m: Origin of the source frame in the target frame.
        quaternion_xyzw: Unit quaternion that turns source vectors into the target frame.
    """

    translation_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    quaternion_xyzw: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)

    def __matmul__(self, other: RigidTransform) -> RigidTransform:
        """Chain: `a_from_c = a_from_b @ b_from_c`."""
        tx, ty, tz = _rotate(self.quaternion_xyzw, other.translation_m)
        ax, ay, az = self.translation_m
        return RigidTransform(
            (ax + tx, ay + ty, az + tz), _multiply(self.quaternion_xyzw, other.quaternion_xyzw)
        )

    def inverse(self) -> RigidTransform:
        """The way back: `b_from_a` of an `a_from_b`."""
        x, y, z, w = self.quaternion_xyzw
        back = (-x, -y, -z, w)
        tx, ty, tz = _rotate(back, self.translation_m)
        return RigidTransform((-tx, -ty, -tz), back)

    def apply(self, points: ArrayLike) -> FloatArray:
        """Points of the source frame, shape (..., 3), in the target frame."""
        return self.rotate(points) + self.translation_m

    def rotate(self, vectors: ArrayLike) -> FloatArray:
        """Directions of the source frame, shape (..., 3), in the target frame."""
        turned: FloatArray = np.asarray(vectors, np.float64) @ self.matrix.T
        return turned

    @property
    def matrix(self) -> FloatArray:
        """Shape (3, 3): the rotation alone."""
        return rotation_matrix(self.quaternion_xyzw)

    @property
    def yaw_rad(self) -> float:
        """Heading of the source frame's x axis in the target's xy plane."""
        x, y, z, w = self.quaternion_xyzw
        return float(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))

    @property
    def roll_rad(self) -> float:
        """Turn of the source frame about its own x axis, from where its y axis lies level."""
        x, y, z, w = self.quaternion_xyzw
        return float(np.arctan2(2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))

    @property
    def planar(self) -> FloatArray:
        """Shape (3,): x_m, y_m, yaw_rad of the source frame in the target frame."""
        return np.array([self.translation_m[0], self.translation_m[1], self.yaw_rad])

    @staticmethod
    def from_planar(x_m: float, y_m: float, yaw_rad: float, z_m: float = 0.0) -> RigidTransform:
        """A body that stands level at (x, y) and looks along `yaw_rad`."""
        return RigidTransform((x_m, y_m, z_m), euler_to_quaternion(0.0, 0.0, yaw_rad))


def interpolate(start: RigidTransform, end: RigidTransform, share: float) -> RigidTransform:
    """Between two transforms: translations linearly, rotations by slerp, as tf2 does.

    Args:
        start: The transform at share 0.
        end: The transform at share 1.
        share: In [0, 1].
    """
    translation = tuple(
        a + (b - a) * share for a, b in zip(start.translation_m, end.translation_m, strict=True)
    )
    p, q = start.quaternion_xyzw, end.quaternion_xyzw
    dot = sum(a * b for a, b in zip(p, q, strict=True))
    sign = -1.0 if dot < 0.0 else 1.0  # of the two ways round, the short one
    dot = min(1.0, abs(dot))
    angle = float(np.arccos(dot))
    if angle < 1e-6:  # sin(angle) would vanish; linear is exact to 1e-13 here
        weight_p, weight_q = 1.0 - share, share * sign
    else:
        weight_p = float(np.sin((1.0 - share) * angle) / np.sin(angle))
        weight_q = float(np.sin(share * angle) / np.sin(angle)) * sign
    mixed = [weight_p * a + weight_q * b for a, b in zip(p, q, strict=True)]
    norm = sum(value * value for value in mixed) ** 0.5
    x, y, z, w = (value / norm for value in mixed)
    return RigidTransform((translation[0], translation[1], translation[2]), (x, y, z, w))


def _multiply(
    p: tuple[float, float, float, float], q: tuple[float, float, float, float]
) -> tuple[float, float, float, float]:
    px, py, pz, pw = p
    qx, qy, qz, qw = q
    return (
        pw * qx + px * qw + py * qz - pz * qy,
        pw * qy - px * qz + py * qw + pz * qx,
        pw * qz + px * qy - py * qx + pz * qw,
        pw * qw - px * qx - py * qy - pz * qz,
    )


def _rotate(
    q: tuple[float, float, float, float], v: tuple[float, float, float]
) -> tuple[float, float, float]:
    x, y, z, w = q
    vx, vy, vz = v
    tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
    return (
        vx + w * tx + y * tz - z * ty,
        vy + w * ty + z * tx - x * tz,
        vz + w * tz + x * ty - y * tx,
    )
