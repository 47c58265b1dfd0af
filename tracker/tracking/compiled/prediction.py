"""Where is everybody by now, and who could see them? `modes`, `motion` and `view`, one by one."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray
from tracker.tracking.compiled.loop import loop, step
from tracker.tracking.view import ARM_M, DEPTH_MIN_M, HALF_BODY_M, OCCLUDED

TURN = 2.0 * np.pi
_TURNS_PER_RAD = 1.0 / TURN


@step
def wrapped(angle_rad: float) -> float:
    """The same direction in [-pi, pi)."""
    return angle_rad - TURN * np.floor((angle_rad + np.pi) * _TURNS_PER_RAD)


@loop
def predict(
    weight: FloatArray,
    mean: FloatArray,
    covariance: FloatArray,
    transition: FloatArray,
    noise: FloatArray,
    switching: FloatArray,
    weights: FloatArray,
    means: FloatArray,
    covariances: FloatArray,
) -> None:
    """Mix the modes, then carry each over the interval: `modes.predict_modes`.

    Every motion here moves a place by `reach` times the speed and keeps `rest` of the speed. The
    prediction is written to the last three.
    """
    modes, people = weight.shape
    for to in range(modes):
        for person in range(people):
            if modes == 2:
                first = switching[0, to] * weight[0, person]
                second = switching[1, to] * weight[1, person]
                weights[to, person] = first + second
                total = max(first + second, 1e-300)
                mix(
                    first / total, second / total, mean, covariance, person,
                    means[to], covariances[to],
                )  # fmt: skip
                _carry(means, covariances, to, person, transition, noise, means, covariances)
            else:
                weights[to, person] = weight[to, person]
                _carry(mean, covariance, to, person, transition, noise, means, covariances)


@step
def mix(
    first: float,
    second: float,
    mean: FloatArray,
    covariance: FloatArray,
    person: int,
    mixed_mean: FloatArray,
    mixed: FloatArray,
) -> None:
    """Moments of the mixture of somebody's two Gaussians, written to their row of the last two.

    Args:
        first: Weight of the first one.
        second: Weight of the second one.
        mean: Shape (2, N, 4).
        covariance: Shape (2, N, 4, 4).
        person: Their row.
        mixed_mean: Shape (N, 4).
        mixed: Shape (N, 4, 4).
    """
    for row in range(4):
        apart = mean[1, person, row] - mean[0, person, row]
        mixed_mean[person, row] = mean[0, person, row] + second * apart
        for column in range(4):
            outer = apart * (mean[1, person, column] - mean[0, person, column])
            mixed[person, row, column] = (
                first * covariance[0, person, row, column]
                + second * covariance[1, person, row, column]
                + first * second * outer
            )


@step
def _carry(
    mean: FloatArray,
    covariance: FloatArray,
    mode: int,
    person: int,
    transition: FloatArray,
    noise: FloatArray,
    new_mean: FloatArray,
    new: FloatArray,
) -> None:
    """F x and F P F' + Q of one track; what is new may take the place of what was."""
    reach, rest = transition[mode, 0, 2], transition[mode, 2, 2]
    for i in range(2):
        speed = mean[mode, person, i + 2]
        new_mean[mode, person, i] = mean[mode, person, i] + reach * speed
        new_mean[mode, person, i + 2] = rest * speed
        for j in range(2):
            to, at = i + 2, j + 2
            place, speed = covariance[mode, person, i, j], covariance[mode, person, to, at]
            right, below = covariance[mode, person, i, at], covariance[mode, person, to, j]
            place += reach * (right + below + reach * speed)
            new[mode, person, i, j] = place + noise[mode, i, j]
            new[mode, person, i, at] = rest * (right + reach * speed) + noise[mode, i, at]
            new[mode, person, to, j] = rest * (below + reach * speed) + noise[mode, to, j]
            new[mode, person, to, at] = rest * rest * speed + noise[mode, to, at]


@loop
def merge_modes(
    weight: FloatArray, mean: FloatArray, covariance: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The one Gaussian of each person: `Belief.merged`."""
    if len(weight) == 1:
        return mean[0], covariance[0]
    means, covariances = np.empty_like(mean[0]), np.empty_like(covariance[0])
    for person in range(weight.shape[1]):
        mix(weight[0, person], weight[1, person], mean, covariance, person, means, covariances)
    return means, covariances


@loop
def visibility(mean: FloatArray, view: FloatArray) -> FloatArray:
    """Chance that nothing but the detector keeps people from being seen: `view.visibility`.

    Args:
        mean: Shape (N, 4).
        view: x_m, y_m, yaw_rad, horizontal_fov_rad and range_max_m; empty where all is in view.
    """
    people = len(mean)
    chance = np.ones(people)
    if len(view) == 0:
        return chance
    x, y, yaw_rad, fov_rad, range_max_m = view
    range_m, bearing_rad = np.empty(people), np.empty(people)
    for person in range(people):
        dx, dy = mean[person, 0] - x, mean[person, 1] - y
        range_m[person] = max(np.hypot(dx, dy), 0.1)
        bearing_rad[person] = np.arctan2(dy, dx)
    for person in range(people):
        if fov_rad < TURN:
            # Whoever stands on the edge is half in view.
            reach = np.arctan2(ARM_M, range_m[person])
            off_axis = abs(wrapped(bearing_rad[person] - yaw_rad))
            chance[person] = min(max((fov_rad / 2 - off_axis) / (2 * reach) + 0.5, 0.0), 1.0)
        if range_m[person] > range_max_m:
            chance[person] = 0.0
        for other in range(people):
            if range_m[other] < range_m[person] - DEPTH_MIN_M:
                beside = abs(wrapped(bearing_rad[person] - bearing_rad[other]))
                if beside < HALF_BODY_M / range_m[other]:
                    chance[person] *= OCCLUDED
                    break
    return chance
