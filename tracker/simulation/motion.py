"""Who is where at a time, and how high is each hand? Way-points turned into states."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray
from tracker.geometry import RigidTransform, normalize_angle
from tracker.simulation.activities import moment_at
from tracker.simulation.interior import Pose2
from tracker.simulation.scene import ARM_MOTION_S, Person, Scene

_STRIDE_M = 1.3  # two steps of a walking grown-up; a guess
_SWING_M = 0.2
_LEG_APART_M = 0.1
_LEG_RADIUS_M = 0.07


@dataclass(frozen=True, slots=True, eq=False)
class People:
    """Everybody of a scene at one instant; row i is the scene's i-th person.

    Attributes:
        id: Shape (P,).
        xy_m: Shape (P, 2): center of the body in the map.
        facing_rad: Shape (P,): where the body looks, in the map.
        raised: Shape (P,): how far the hand is up, 0 to 1.
        swing: Shape (P,): how far a hand that waves is outward, -1 to 1; 0 for others.
        legs: Shape (P, 2, 3): x_m, y_m, radius_m of both legs in the map, as the scanner
            meets them.
        doing: For each person the activity and which of its moments; None where the hand rests or
            is on its way up or down.
    """

    id: IntArray
    xy_m: FloatArray
    facing_rad: FloatArray
    raised: FloatArray
    swing: FloatArray
    legs: FloatArray
    doing: tuple[tuple[str, int] | None, ...]

    @property
    def hand_up(self) -> BoolArray:
        """Shape (P,): the hand is fully up."""
        return self.raised >= 1.0


def robot_pose(scene: Scene, time_s: float) -> RigidTransform:
    """`map_from_base_link` at a time; the drive eases in and out of its way-points."""
    path = scene.robot.path
    times = [point.at_s for point in path]
    row = int(np.searchsorted(times, time_s, side="right")) - 1
    if row < 0:
        return planar_transform(path[0])
    if row == len(path) - 1:
        return planar_transform(path[-1])
    start, end = path[row], path[row + 1]
    share = (time_s - start.at_s) / (end.at_s - start.at_s)
    share = share * share * (3.0 - 2.0 * share)
    return RigidTransform.from_planar(
        start.x_m + (end.x_m - start.x_m) * share,
        start.y_m + (end.y_m - start.y_m) * share,
        float(np.radians(start.yaw_deg + (end.yaw_deg - start.yaw_deg) * share)),
    )


def planar_transform(pose: Pose2) -> RigidTransform:
    """A scene file's place and direction as `parent_from_child`."""
    return RigidTransform.from_planar(pose.x_m, pose.y_m, float(np.radians(pose.yaw_deg)))


def people_at(scene: Scene, time_s: float) -> People:
    """Everybody's state at a time; people walk straight and evenly between way-points."""
    robot_xy = robot_pose(scene, time_s).planar[:2]
    count = len(scene.people)
    xy, facing = np.zeros((count, 2)), np.zeros(count)
    raised, waves, legs = np.zeros(count), np.zeros(count), np.zeros((count, 2, 3))
    for row, person in enumerate(scene.people):
        xy[row], facing[row], swing = _walk(person, time_s, robot_xy)
        raised[row] = _raised(person, time_s)
        if raised[row] >= 1.0 and person.wave_hz:
            waves[row] = np.sin(2.0 * np.pi * person.wave_hz * time_s)
        forward = np.array([np.cos(facing[row]), np.sin(facing[row])])
        left = np.array([-forward[1], forward[0]])
        middle = xy[row] + (forward * person.shins_m if person.seat_m is not None else 0.0)
        for leg, side in enumerate((1.0, -1.0)):
            place = middle + side * (_LEG_APART_M * left + swing * forward)
            legs[row, leg] = (*place, _LEG_RADIUS_M)
    ids = np.array([person.id for person in scene.people], dtype=np.int64)
    doing = tuple(
        None if height > 0.0 else _doing(person, time_s)
        for person, height in zip(scene.people, raised, strict=True)
    )
    return People(ids, xy, facing, raised, waves, legs, doing)


def _walk(person: Person, time_s: float, robot_xy: FloatArray) -> tuple[FloatArray, float, float]:
    path = person.path
    times = np.array([point.at_s for point in path])
    places = np.array([(point.x_m, point.y_m) for point in path])
    xy = np.array([np.interp(time_s, times, places[:, axis]) for axis in (0, 1)])
    row = int(np.searchsorted(times, time_s, side="right")) - 1
    step = places[row + 1] - places[row] if 0 <= row < len(path) - 1 else np.zeros(2)
    walks = bool(np.any(step != 0.0))
    swing = 0.0
    if walks:
        lengths = np.linalg.norm(np.diff(places, axis=0), axis=1)
        gone = lengths[:row].sum() + np.linalg.norm(xy - places[row])
        swing = _SWING_M * float(np.sin(2 * np.pi * gone / _STRIDE_M))
    facing = _given_facing(person, times, time_s)
    if facing is None:
        ahead = step if walks else robot_xy - xy
        facing = float(np.arctan2(ahead[1], ahead[0]))
    return xy, facing, swing


def _given_facing(person: Person, times: FloatArray, time_s: float) -> float | None:
    row = max(int(np.searchsorted(times, time_s, side="right")) - 1, 0)
    start = person.path[row].facing_deg
    if start is None:
        return None
    end = person.path[row + 1].facing_deg if row + 1 < len(person.path) else None
    if end is None:
        return float(np.radians(start))
    share = np.clip((time_s - times[row]) / (times[row + 1] - times[row]), 0.0, 1.0)
    turn = normalize_angle(np.radians(end - start))  # the short way round
    return float(np.radians(start) + share * turn)


def _raised(person: Person, time_s: float) -> float:
    height = 0.0
    for each in person.raises:
        if each.from_s <= time_s < each.until_s:
            return 1.0
        away_s = max(each.from_s - time_s, time_s - each.until_s)
        # Never quite 1 outside the span, so that the truth is the scene file to the nanosecond.
        height = max(height, min(1.0 - away_s / ARM_MOTION_S, 0.999))
    return height


def _doing(person: Person, time_s: float) -> tuple[str, int] | None:
    for each in person.activities:
        if each.from_s <= time_s < each.until_s:
            return each.what, moment_at(each.what, each.tempo * (time_s - each.from_s))
    return None
