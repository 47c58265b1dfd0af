"""How late are a sensor's stamps? From people who stand still while the robot turns.

A sensor whose stamps are late by t shows what was before. With the robot's turn rate w, the
heading of somebody at p, seen from s, comes out in the fixed frame as

    heading_i = atan2(p - s_i) + a + w_i t + noise

with an a of each person's own, since a hand stays where it is beside its body. Least squares over
all of them give t. The robot should turn on its place: what a drive adds is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from tracker.camera import CameraModel
from tracker.config import Config
from tracker.containers import FloatArray, FrameResult, IntArray
from tracker.errors import CalibrationError
from tracker.geometry import RigidTransform, normalize_angle
from tracker.ranging.measuring import scan_people
from tracker.ranging.rays import hand_rays

#: A body of the scan that is nearer to a customer is the customer's (guess).
_NEAR_M = 0.4
#: Errors within so long are alike: they count as one.
_ALIKE_S = 1.0
#: Errors beyond so many standard deviations pull no harder (Huber: 95 % efficient if Gaussian).
_HUBER = 1.345
_ROUNDS = 10
#: How well the turn rate between images is known, relatively (guess).
_RATE_STD_SHARE = 0.05
#: What is known no better than this is not determined at all.
_STD_MAX_S = 0.03


@dataclass(frozen=True, slots=True, eq=False)
class Headings:
    """Where one sensor saw people, and how the robot turned meanwhile.

    Attributes:
        stamp_ns: Shape (K,), of the sensor's data.
        heading_rad: Shape (K,), in the fixed frame.
        origin_m: Shape (K, 2): where the sensor was, as transforms tell ...
        place_m: ... and where the tracker has the person.
        person: Shape (K,): a number of its own for each person, and each time a hand is up.
        image_ns: Shape (F,): stamps of the images ...
        yaw_rad: ... and the camera's yaw at each, as transforms tell.
    """

    stamp_ns: IntArray
    heading_rad: FloatArray
    origin_m: FloatArray
    place_m: FloatArray
    person: IntArray
    image_ns: IntArray
    yaw_rad: FloatArray

    @staticmethod
    def concatenate(parts: Sequence[Headings]) -> Headings:
        """Images one after the other, in the order of their stamps."""
        columns = [[getattr(part, item.name) for part in parts] for item in fields(Headings)]
        return Headings(*(np.concatenate(column) for column in columns))

    def __getitem__(self, rows: Any) -> Headings:
        columns = [getattr(self, item.name) for item in fields(Headings)]
        return Headings(*(column[rows] for column in columns[:-2]), *columns[-2:])

    @property
    def turn_rate_radps(self) -> FloatArray:
        """Shape (K,): how fast the robot turned."""
        if len(self.image_ns) < 2:
            return np.zeros(len(self.stamp_ns))
        at_s = (self.image_ns - self.image_ns[0]) / 1e9
        rate = np.gradient(np.unwrap(self.yaw_rad), at_s)
        return np.asarray(np.interp((self.stamp_ns - self.image_ns[0]) / 1e9, at_s, rate))


@dataclass(frozen=True, slots=True)
class StampOffset:
    """By how much a sensor's stamps are late, beyond what the configuration says already.

    Attributes:
        offset_s: Negative where they are early.
        std_s: Its standard deviation.
        headings: How many it was found from.
    """

    offset_s: float
    std_s: float
    headings: int


def headings_of(
    result: FrameResult, camera: CameraModel, fixed_from_camera: RigidTransform, config: Config
) -> tuple[Headings, Headings]:
    """Hands and bodies of the customers who call in one image.

    Args:
        result: Of the pipeline.
        camera: Intrinsics of the full image.
        fixed_from_camera: The camera with body axes, where it is believed to be.
        config: Person-sized lengths, and `bearing_convention`.

    Returns:
        What the camera saw, and what the laser saw.
    """
    rays = hand_rays(result.hands, camera, fixed_from_camera, config)
    images = np.array([result.stamp_ns]), rays.origin[2:]
    calling = result.tracks[result.tracks.raised]
    number = calling.id + calling.raised_since_ns
    place_m = calling.mean[:, :2]

    def seen(stamp_ns: int, origin_m: FloatArray, row: IntArray, heading: FloatArray) -> Headings:
        stamps_ns, origins_m = np.full(len(row), stamp_ns), np.tile(origin_m, (len(row), 1))
        return Headings(stamps_ns, heading, origins_m, place_m[row], number[row], *images)

    shown = np.flatnonzero(calling.hand >= 0)
    heading = rays.bearing_rad[calling.hand[shown]] + rays.origin[2]
    hands = seen(result.stamp_ns, rays.origin[:2], shown, heading)
    if result.scan is None:
        return hands, hands[:0]
    people, laser_m = scan_people(result.scan, config), result.scan.laser_xy_m
    apart_m = np.linalg.norm(place_m[:, None] - people.xy_m, axis=-1)
    track, body = np.nonzero(apart_m < _NEAR_M)
    heading = _heading(people.xy_m[body] - laser_m)
    return hands, seen(result.scan.stamp_ns, laser_m, track, heading)


def stamp_offset(headings: Headings) -> StampOffset:
    """Find the offset by robust least squares, taking errors within a second for one.

    Args:
        headings: Of one sensor.

    Raises:
        CalibrationError: They do not tell; the message says what to record.

    Source: Liang and Zeger, "Longitudinal data analysis using generalized linear models", 1986,
        for the variance under errors that are alike within groups.
    """
    turn = headings.turn_rate_radps
    known = np.isfinite(headings.heading_rad)
    turn, seen = turn[known], headings[known]
    people, person = np.unique(seen.person, return_inverse=True)
    weight = np.ones(len(person))
    place_m = np.stack([_mean_of_each(person, axis, weight) for axis in seen.place_m.T], axis=-1)
    away = normalize_angle(seen.heading_rad - _heading(place_m - seen.origin_m))
    offset_s, left, moved = 0.0, away, turn
    for _ in range(_ROUNDS):
        moved = turn - _mean_of_each(person, turn, weight)
        left = away - _mean_of_each(person, away, weight)
        offset_s = float((weight * moved * left).sum() / max((weight * moved**2).sum(), 1e-12))
        left = left - offset_s * moved
        scatter = max(1.4826 * float(np.median(np.abs(left))), 1e-6) if len(left) else 1.0
        weight = np.minimum(1.0, _HUBER * scatter / np.maximum(np.abs(left), 1e-12))
    group = np.unique(seen.stamp_ns // round(_ALIKE_S * 1e9), return_inverse=True)[1]
    pulls = np.bincount(group, weight * moved * left) if len(left) else np.zeros(1)
    std_s = float(np.sqrt((pulls**2).sum()) / max((weight * moved**2).sum(), 1e-12))
    std_s = float(np.hypot(std_s, _RATE_STD_SHARE * offset_s))
    if len(left) <= len(people) + 1 or not 0.0 < std_s <= _STD_MAX_S:
        raise CalibrationError(
            f"{len(left)} headings do not determine the offset of the stamps. Record for a "
            "minute while the robot turns left and right on the spot, at 0.5 rad/s or more, in "
            "front of people who stand still with a hand up."
        )
    return StampOffset(offset_s, std_s, len(left))


def _heading(offset_m: FloatArray) -> FloatArray:
    return np.arctan2(offset_m[:, 1], offset_m[:, 0])


def _mean_of_each(person: IntArray, values: FloatArray, weight: FloatArray) -> FloatArray:
    """Shape (K,): the weighted mean over the rows of the same person."""
    total = np.bincount(person, weight * values) / np.maximum(np.bincount(person, weight), 1e-12)
    return np.asarray(total[person])
