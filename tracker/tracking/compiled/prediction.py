"""Where is everybody by now, and who could see them? `modes`, `motion` and `view`, one by one."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray
from tracker.tracking.compiled.loop import loop
from tracker.tracking.view import ARM_M, DEPTH_MIN_M, HALF_BODY_M, OCCLUDED

TURN = 2.0 * np.pi


@loop
def wrapped(angle_rad: float) -> float:
    """The same direction in [-pi, pi)."""
    return angle_rad - TURN * np.floor((angle_rad + np.pi) / TURN)


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
        reach, rest = transition[to, 0, 2], transition[to, 2, 2]
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
            else:
                weights[to, person] = weight[to, person]
                for row in range(4):
                    means[to, person, row] = mean[to, person, row]
                    for column in range(4):
                        covariances[to, person, row, column] = covariance[to, person, row, column]
            _carry(means, covariances, to, person, reach, rest)
            for row in range(4):
                for column in range(4):
                    covariances[to, person, row, column] += noise[to, row, column]


@loop
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


@loop
def _carry(
    mean: FloatArray, covariance: FloatArray, mode: int, person: int, reach: float, rest: float
) -> None:
    """F x and F P F' of one track, in place."""
    for axis in range(2):
        mean[mode, person, axis] += reach * mean[mode, person, axis + 2]
        mean[mode, person, axis + 2] *= rest
    for axis in range(2):
        for column in range(4):
            speed = covariance[mode, person, axis + 2, column]
            covariance[mode, person, axis, column] += reach * speed
            covariance[mode, person, axis + 2, column] = rest * speed
    for row in range(4):
        for axis in range(2):
            speed = covariance[mode, person, row, axis + 2]
            covariance[mode, person, row, axis] += reach * speed
            covariance[mode, person, row, axis + 2] = rest * speed


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
