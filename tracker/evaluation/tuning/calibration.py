"""What is the camera's true pose relative to the laser? Estimated from raised hands.

The camera tells in which direction a hand is, the laser where bodies stand. With d the camera's
place and psi its yaw, both seen from where it is believed to be, a body at p whose hand is up to
the side s by a reach b is expected at the bearing

    h = atan2(q_y, q_x) - atan2(s b, |q|),    q = R(-psi) (p - d).

Yaw moves near and far hands by the same angle, an offset the near ones more, and the reach those
of the left and the right by opposite angles: people who call at several distances, from several
directions and with either hand tell all four apart.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from tracker.containers import FloatArray, IntArray
from tracker.errors import CalibrationError
from tracker.evaluation.tuning.sightings import Sightings
from tracker.geometry import RigidTransform, normalize_angle

#: A hand stands to the same side of its body for so long: its errors meanwhile count as one.
ALIKE_S = 5.0
#: Errors beyond so many standard deviations pull no harder (Huber: 95 % efficient if Gaussian).
_HUBER = 1.345
#: What is known no better than this is not determined at all.
_YAW_STD_MAX_RAD, _OFFSET_STD_MAX_M = np.deg2rad(5.0), 0.25
_ROUNDS = 20
_START = np.array([0.0, 0.0, 0.0, 0.3])  # x_m, y_m, yaw_rad, reach_m


@dataclass(frozen=True, slots=True, eq=False)
class Calibration:
    """The camera's true pose, seen from the one that the transforms tell.

    Attributes:
        correction: x_m, y_m, yaw_rad of the true camera in the believed camera's body frame
            (x forward, y left).
        covariance: Shape (3, 3), of `correction`, in the squares of its units.
        reach_m: How far raised hands stand beside their bodies, on average.
        scatter_m: Standard deviation of where hands stand around that, robust.
        rows: Shape (K,): the rows of the sightings that were taken, one for each hand.
        error_rad: Shape (K,): measured minus expected bearing of each.
        groups: Stretches of `ALIKE_S` with hands in them: so many errors count as independent.
    """

    correction: FloatArray
    covariance: FloatArray
    reach_m: float
    scatter_m: float
    rows: IntArray
    error_rad: FloatArray
    groups: int

    @property
    def std(self) -> FloatArray:
        """Shape (3,): standard deviations of `correction`."""
        return np.sqrt(np.diag(self.covariance))

    def apply_to(self, target_from_camera: RigidTransform) -> RigidTransform:
        """A believed mounting, with body axes, as it should have been."""
        return target_from_camera @ RigidTransform.from_planar(*map(float, self.correction))


def calibrate(sightings: Sightings) -> Calibration:
    """Find the camera's pose that brings hands and bodies together, by robust least squares.

    Each hand is given the body that fits it best, the pose is found, and again, until nothing
    changes. The covariance supposes that the errors within `ALIKE_S` are one and the same, and
    that people face the camera. Where they face along its axis instead, as drawn people do, the
    forward offset comes out too small by about reach^2 / distance: 4 cm at 3 m.

    Args:
        sightings: Hands and the bodies that could be theirs.

    Raises:
        CalibrationError: There are too few hands, or they do not tell yaw and offset apart; the
            message says what to record.

    Source: Huber and Ronchetti, "Robust Statistics", 2nd edition, 2009, section 7.6, for the
        covariance of a robust estimate.
    """
    group = (sightings.stamp_ns // round(ALIKE_S * 1e9)).astype(np.int64)
    groups = len(np.unique(group))
    has_sides = bool(np.any(sightings.side != 0.0))
    free = np.arange(4 if has_sides else 3)
    if groups <= len(free):
        raise CalibrationError(
            f"Raised hands beside bodies were seen in {groups} stretches of {ALIKE_S:g} s; at "
            f"least {len(free) + 1} are needed. Record for a minute or more, with people who "
            "raise hands in view of camera and laser."
        )
    state = _START if has_sides else np.append(_START[:3], 0.0)
    rows = _best_rows(sightings, state)
    for _ in range(_ROUNDS):
        state = _fit(sightings[rows], state, free)
        before, rows = rows, _best_rows(sightings, state)
        if np.array_equal(before, rows):
            break
    taken = sightings[rows]
    error = _errors(taken, state)
    # So many errors as there are groups, less what the estimate itself has taken of them.
    covariance = _covariance(taken, state, free) * len(rows) / (groups - len(free))
    _check_determined(np.sqrt(np.diag(covariance)))
    lateral_m = np.abs(error) * np.hypot(taken.body_xy_m[:, 0], taken.body_xy_m[:, 1])
    return Calibration(
        correction=state[:3],
        covariance=covariance[:3, :3],
        reach_m=float(state[3]),
        scatter_m=float(1.4826 * np.median(lateral_m)),
        rows=rows,
        error_rad=error,
        groups=groups,
    )


def expected_bearings(sightings: Sightings, correction: FloatArray, reach_m: float) -> FloatArray:
    """Bearings at which hands should be seen, from a camera that stands elsewhere.

    Args:
        sightings: Bodies in the believed camera's frame, and their hands' sides.
        correction: x_m, y_m, yaw_rad of the true camera in that frame.
        reach_m: How far hands stand beside their bodies.

    Returns:
        Shape (K,), radians in the true camera's frame, counter-clockwise.
    """
    offset = sightings.body_xy_m - correction[:2]
    range_m = np.maximum(np.hypot(offset[:, 0], offset[:, 1]), 0.05)
    body = np.arctan2(offset[:, 1], offset[:, 0]) - correction[2]
    return normalize_angle(body - np.arctan2(sightings.side * reach_m, range_m))


def _errors(sightings: Sightings, state: FloatArray) -> FloatArray:
    expected = expected_bearings(sightings, state[:3], float(state[3]))
    return normalize_angle(sightings.bearing_rad - expected)


def _best_rows(sightings: Sightings, state: FloatArray) -> IntArray:
    """For each hand the row of the body that fits it best."""
    misfit = (_errors(sightings, state) / sightings.std_rad) ** 2 + sightings.size_misfit
    order = np.lexsort((misfit, sightings.hand))
    first = np.diff(sightings.hand[order], prepend=-1) != 0
    return np.asarray(order[first])


def _fit(sightings: Sightings, state: FloatArray, free: IntArray) -> FloatArray:
    def normalized(values: FloatArray) -> FloatArray:
        moved = state.copy()
        moved[free] = values
        return np.asarray(_errors(sightings, moved) / sightings.std_rad)

    result = np.array(state)
    found = least_squares(normalized, state[free], loss="huber", f_scale=_HUBER)
    result[free] = found.x
    return np.asarray(result)


def _covariance(sightings: Sightings, state: FloatArray, free: IntArray) -> FloatArray:
    """Of the free numbers, for independent errors: E[psi^2] / E[psi']^2 inv(J'J)."""
    error = _errors(sightings, state) / sightings.std_rad
    pulled = np.clip(error, -_HUBER, _HUBER)
    inside = max(float(np.mean(np.abs(error) < _HUBER)), 0.05)
    step = 1e-6
    shifted = [_errors(sightings, state + step * np.eye(4)[number]) for number in free]
    slope = normalize_angle(np.stack(shifted, axis=-1) - _errors(sightings, state)[:, None]) / step
    slope = slope / sightings.std_rad[:, None]
    spread = float(np.mean(pulled**2)) / inside**2
    return np.asarray(spread * np.linalg.pinv(slope.T @ slope, rcond=1e-12, hermitian=True))


def _check_determined(std: FloatArray) -> None:
    limits = (_OFFSET_STD_MAX_M, _OFFSET_STD_MAX_M, _YAW_STD_MAX_RAD, _OFFSET_STD_MAX_M)
    remedies = (
        "people far to the left and right of the picture",
        "people near and far",
        "people near and far",
        "people who raise the left hand, and others who raise the right",
    )
    if np.all(np.isfinite(std)) and np.all(std <= limits[: len(std)]):
        return
    worst = int(np.argmax(std / limits[: len(std)]))
    name = ("forward offset", "sideways offset", "yaw", "reach of the hands")[worst]
    known = f"{np.rad2deg(std[2]):.3g} deg" if worst == 2 else f"{std[worst]:.3g} m"
    raise CalibrationError(
        f"The hands do not determine the {name}: its standard deviation is {known}. Record "
        f"{remedies[worst]}, or longer."
    )
