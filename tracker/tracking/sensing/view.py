"""Whom could the sensors see? Field of view, range, and people who stand in front."""

from __future__ import annotations

import numpy as np

from tracker.compiling.loops import loop, maker
from tracker.containers import FloatArray, View
from tracker.containers.arrays import sealed
from tracker.tracking.sensing.sensor_kinds import wrapped

#: Half a body: who stands this close to the line of sight covers it.
HALF_BODY_M = 0.2
#: A body with its arm: at the edge of the view part of it is seen.
ARM_M = 0.3
#: Somebody in front hides at least from this distance on; nearer they stand side by side.
DEPTH_MIN_M = 0.3
#: Share of the time that somebody behind another is seen nevertheless (guess).
OCCLUDED = 0.2


#: No view: everything is in view.
_EVERYWHERE = sealed(np.zeros(0))


def view_numbers(view: View | None) -> FloatArray:
    """A view for the loops: x_m, y_m, yaw_rad, field of view and range; empty for everywhere."""
    if view is None:
        return _EVERYWHERE
    x_m, y_m, yaw_rad = view.sensor_pose
    return sealed(np.array([x_m, y_m, yaw_rad, view.horizontal_fov_rad, view.range_max_m]))


@maker
def visibility(mean: FloatArray, view: FloatArray) -> FloatArray:
    """Probability that a person is in view and not hidden.

    Args:
        mean: Shape (1, N, 4), in the fixed frame.
        view: From `view_numbers`.

    Returns:
        Shape (N,): 0 outside the field of view, between at its edge, little behind somebody else,
        1 in plain sight.
    """
    people = mean.shape[1]
    chance, range_m, bearing_rad = np.empty(people), np.empty(people), np.empty(people)
    for person in range(people):
        chance[person] = 1.0
        if len(view) > 0:
            dx, dy = mean[0, person, 0] - view[0], mean[0, person, 1] - view[1]
            range_m[person] = max(np.sqrt(dx * dx + dy * dy), 0.1)
            bearing_rad[person] = np.arctan2(dy, dx)
    if len(view) == 0:
        return chance
    for person in range(people):
        if view[3] < 2.0 * np.pi:
            # Whoever stands on the edge is half in view.
            reach = np.arctan2(ARM_M, range_m[person])
            off_axis = abs(wrapped(bearing_rad[person] - view[2]))
            chance[person] = min(max((view[3] / 2 - off_axis) / (2 * reach) + 0.5, 0.0), 1.0)
        if range_m[person] > view[4]:
            chance[person] = 0.0
        if _is_hidden(person, range_m, bearing_rad):
            chance[person] *= OCCLUDED
    return chance


@loop
def _is_hidden(person: int, range_m: FloatArray, bearing_rad: FloatArray) -> bool:
    for other in range(len(range_m)):
        if range_m[other] < range_m[person] - DEPTH_MIN_M:
            beside = abs(wrapped(bearing_rad[person] - bearing_rad[other]))
            if beside < HALF_BODY_M / range_m[other]:
                return True
    return False
