"""What does a sensor measure of a person? For each kind: expect, jacobian, area, begin.

    kind             numbers                   h(x)
    bearing, range   bearing_rad, range_m      atan2(dy, dx) - yaw,  |d|      d = x - sensor
    bearing          bearing_rad, -            atan2(dy, dx) - yaw
    range            -, range_m                |d|
    position         x_m, y_m                  x, y

Every kind has two numbers, so that all go through the same arithmetic. One that is missing is
always 0, is expected to be 0 whatever the place, and has variance 1: it weighs nothing.
"""

from __future__ import annotations

import numpy as np

from tracker.compiling.loops import step
from tracker.containers import SensorKind
from tracker.tracking.sensing.claims import Claims
from tracker.tracking.settings import Settings

BEARING_RANGE, POSITION = int(SensorKind.BEARING_RANGE), int(SensorKind.POSITION)
BEARING, RANGE = int(SensorKind.BEARING), int(SensorKind.RANGE)
KINDS = len(SensorKind)
#: Nearer than this to the sensor a bearing turns too fast to be linear.
RANGE_FLOOR_M = 0.1
_TURN = 2.0 * np.pi


@step
def wrapped(angle_rad: float) -> float:
    """The same direction in [-pi, pi)."""
    return angle_rad - _TURN * np.floor((angle_rad + np.pi) * (1.0 / _TURN))


@step
def expect(kind: int, x: float, y: float, claims: Claims, row: int) -> tuple[float, float]:
    """h(x): the two numbers that the sensor of a claim would measure of somebody there."""
    if kind == POSITION:
        return x, y
    dx, dy = x - claims.pose[row, 0], y - claims.pose[row, 1]
    bearing_rad, range_m = 0.0, 0.0
    if kind != RANGE:
        bearing_rad = wrapped(np.arctan2(dy, dx) - claims.pose[row, 2])
    if kind != BEARING:
        range_m = max(np.sqrt(dx * dx + dy * dy), RANGE_FLOOR_M)
    return bearing_rad, range_m


@step
def jacobian(
    kind: int, x: float, y: float, claims: Claims, row: int
) -> tuple[float, float, float, float]:
    """H: derivatives of the two numbers by x and y, row by row."""
    if kind == POSITION:
        return 1.0, 0.0, 0.0, 1.0
    dx, dy = x - claims.pose[row, 0], y - claims.pose[row, 1]
    per_m = 1.0 / max(np.sqrt(dx * dx + dy * dy), RANGE_FLOOR_M)
    cos, sin = dx * per_m, dy * per_m
    turn_x, turn_y = -sin * per_m, cos * per_m
    if kind == RANGE:
        turn_x = turn_y = 0.0
    if kind == BEARING:
        cos = sin = 0.0
    return turn_x, turn_y, cos, sin


@step
def area(kind: int, claims: Claims, row: int, settings: Settings) -> float:
    """The area in square meters that one unit of the measured numbers covers.

    A density that is even over the area is so many times as large in the claim's numbers: r for a
    bearing and a range, r_max^2 / 2 for a bearing alone, 2 pi r for a range alone.
    """
    range_m = max(claims.values[row, 1], RANGE_FLOOR_M)
    if kind == BEARING_RANGE:
        return range_m
    if kind == BEARING:
        return settings.person_range_max_m**2 / 2.0
    if kind == RANGE:
        return _TURN * range_m
    return 1.0


@step
def begin(
    kind: int, claims: Claims, row: int, settings: Settings
) -> tuple[float, float, float, float, float]:
    """x, y and their covariance (xx, xy, yy) of somebody who is new.

    A bearing alone is supposed at `unknown_range_m`; a range alone is a ring around the sensor.
    """
    first, second = claims.values[row, 0], claims.values[row, 1]
    r00, r01, r11 = claims.noise[row, 0, 0], claims.noise[row, 0, 1], claims.noise[row, 1, 1]
    if kind == POSITION:
        return first, second, r00, r01, r11
    if kind == RANGE:
        half = (second * second + r11) / 2.0
        return claims.pose[row, 0], claims.pose[row, 1], half, 0.0, half
    if kind == BEARING:
        second, r11 = settings.unknown_range_m, settings.unknown_range_std_m**2
        r01 = 0.0
    angle = first + claims.pose[row, 2]
    cos, sin = np.cos(angle), np.sin(angle)
    x, y = claims.pose[row, 0] + second * cos, claims.pose[row, 1] + second * sin
    range_m = max(second, RANGE_FLOOR_M)
    across, along = sin * second / range_m, cos * second / range_m
    d00, d01, d11 = pose_doubt(-across / range_m, along / range_m, along, across, claims, row)
    r00, r01, r11 = r00 + d00, r01 + d01, r11 + d11
    h00, h01, h10, h11 = -range_m * sin, cos, range_m * cos, sin  # the place by the numbers
    a0, a1 = h00 * r00 + h01 * r01, h00 * r01 + h01 * r11
    b0, b1 = h10 * r00 + h11 * r01, h10 * r01 + h11 * r11
    return x, y, a0 * h00 + a1 * h01, a0 * h10 + a1 * h11, b0 * h10 + b1 * h11


@step
def pose_doubt(
    h00: float, h01: float, h10: float, h11: float, claims: Claims, row: int
) -> tuple[float, float, float]:
    """Covariance (00, 01, 11) that the doubt about the sensor's own pose adds to a claim's noise.

    A sensor that moves by (dx, dy) is a person who moves by (-dx, -dy); a sensor that turns takes
    its turn off the bearing: the derivatives by x, y and yaw are (-H, (-1, 0)), all of one sign.
    The error is taken for independent from claim to claim, although all those of one frame share
    it: the tracks' covariances are right one by one, their correlation is not kept.
    """
    doubt = claims.doubt
    xx, xy, yy = doubt[row, 0, 0], doubt[row, 0, 1], doubt[row, 1, 1]
    x_turn, y_turn, turn = doubt[row, 0, 2], doubt[row, 1, 2], doubt[row, 2, 2]
    if claims.kind[row] == RANGE:
        x_turn = y_turn = turn = 0.0
    if claims.kind[row] == POSITION:
        return 0.0, 0.0, 0.0
    a0, a1 = xx * h00 + xy * h01 + x_turn, xy * h00 + yy * h01 + y_turn
    a2 = x_turn * h00 + y_turn * h01 + turn
    b0, b1 = xx * h10 + xy * h11, xy * h10 + yy * h11
    b2 = x_turn * h10 + y_turn * h11
    return h00 * a0 + h01 * a1 + a2, h00 * b0 + h01 * b1 + b2, h10 * b0 + h11 * b1
