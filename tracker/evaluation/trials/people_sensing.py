"""Simulated sensors: noise, delay, missed detections and clutter."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray, Measurements, View
from tracker.evaluation.trials.people_scene import PeopleScene
from tracker.evaluation.trials.scenario import PeopleScenario
from tracker.geometry import normalize_angle

_CLUSTER_BEARING_STD_RAD = 0.01
_HIDDEN_SHARE = 0.9  # somebody behind another is still seen now and then


@dataclass(frozen=True, slots=True, eq=False)
class Sensed:
    """What the tracker gets of one frame.

    Attributes:
        measurements: Raised hands, clutter among them, then clusters of the scan, if any.
        view: Where the robot believes to be, and what its camera can see from there.
        scan_view: What its laser can see; None without one.
    """

    measurements: Measurements
    view: View
    scan_view: View | None


@dataclass(frozen=True, slots=True, eq=False)
class SensedFrames:
    """What the tracker gets of T frames.

    Attributes:
        measurements: One frame's behind the other's, in the order of `Sensed`.
        begins: Shape (T + 1,): row of each frame's first measurement, and how many there are.
        poses: Shape (T, 3): x_m, y_m, yaw_rad where the robot believes to be.
        field_of_view_rad: Of its camera.
        has_scan: It has a laser, which looks everywhere.
    """

    measurements: Measurements
    begins: IntArray
    poses: FloatArray
    field_of_view_rad: float
    has_scan: bool

    def __len__(self) -> int:
        return len(self.poses)

    def __iter__(self) -> Iterator[Sensed]:
        for frame, pose in enumerate(self.poses):
            yield Sensed(
                self.measurements[self.begins[frame] : self.begins[frame + 1]],
                View(pose, self.field_of_view_rad),
                View(pose, 2 * np.pi) if self.has_scan else None,
            )


def sense(scenario: PeopleScenario, scene: PeopleScene, rng: np.random.Generator) -> SensedFrames:
    """Measure a scene.

    Args:
        scenario: Noise and faults.
        scene: What is there to be seen.
        rng: All randomness; drawn in the same order whatever the frames show.
    """
    xy = scene.shown_xy_m
    range_m = np.linalg.norm(xy, axis=-1)
    bearing = np.arctan2(xy[..., 1], xy[..., 0]) - scene.shown_yaw_rad[:, None]
    there = np.isfinite(range_m) & (range_m > 0.3)
    seen = there & ~_hidden(range_m, bearing, scenario.body_width_m, rng)
    hands = _hands(scenario, scene, seen, bearing, range_m, rng)
    clusters = _clusters(scenario, seen, bearing, range_m, rng)
    poses = _poses(scenario, scene.robot_yaw_rad, rng)
    measured = _joined(hands, clusters, *_clutter(scenario, scene.shown_yaw_rad, rng))
    measurements = Measurements.polar(
        normalize_angle(measured.bearing_rad),
        np.maximum(measured.range_m, 0.05),
        measured.bearing_std_rad,
        scenario.range_std_m,
        poses[measured.frame],
        raised=measured.raised,
    )
    pose_std = [scenario.pose_std_m, scenario.pose_std_m, np.deg2rad(scenario.pose_std_deg)]
    doubt = np.tile(np.diag(np.square(pose_std)), (len(measurements), 1, 1))
    bias = _bias(scenario, scene, measured, poses)
    return SensedFrames(
        replace(measurements, sensor_pose_covariance=doubt, bias_covariance=bias),
        np.searchsorted(measured.frame, np.arange(len(poses) + 1)),
        poses,
        float(np.deg2rad(scenario.field_of_view_deg)),
        has_scan=scenario.scan_detection_probability > 0.0,
    )


class _Rows(NamedTuple):
    """What was measured of one kind, shape (C,) each, frames ascending."""

    frame: IntArray
    bearing_rad: FloatArray
    range_m: FloatArray
    bearing_std_rad: FloatArray
    raised: BoolArray


def _joined(hands: _Rows, clusters: _Rows, false_hands: _Rows, false_clusters: _Rows) -> _Rows:
    """All of them, frame by frame in the order of `Sensed`."""
    kinds = hands, false_hands, clusters, false_clusters
    order = np.argsort(np.concatenate([rows.frame for rows in kinds]), kind="stable")
    return _Rows(*(np.concatenate(column)[order] for column in zip(*kinds, strict=True)))


def _hands(
    scenario: PeopleScenario,
    scene: PeopleScene,
    seen: BoolArray,
    bearing_rad: FloatArray,
    range_m: FloatArray,
    rng: np.random.Generator,
) -> _Rows:
    """Raised hands of people whom nobody hides; arrays of shape (T, P)."""
    seen = seen & scene.truth.hand_up & scene.truth.in_view
    seen &= rng.random(seen.shape) < scenario.detection_probability
    beside = np.arctan2(scenario.hand_offset_m * scene.hand_side, np.where(seen, range_m, 1.0))
    noise_rad = np.deg2rad(scenario.bearing_std_deg)
    bearing_rad = bearing_rad + beside + noise_rad * rng.standard_normal(seen.shape)
    measured_m = range_m + scenario.range_std_m * rng.standard_normal(seen.shape)
    off = rng.random(seen.shape) < scenario.outlier_share
    measured_m += np.where(off, scenario.outlier_m * rng.random(seen.shape), 0.0)
    measured_m[rng.random(seen.shape) < scenario.range_missing_share] = np.nan
    return _Rows(
        np.nonzero(seen)[0],
        bearing_rad[seen],
        measured_m[seen],
        _hand_std_rad(scenario, range_m[seen]),
        np.ones(np.count_nonzero(seen), dtype=bool),
    )


def _hand_std_rad(scenario: PeopleScenario, range_m: FloatArray) -> FloatArray:
    beside = np.arctan2(scenario.hand_offset_m, range_m)
    return np.asarray(np.hypot(np.deg2rad(scenario.bearing_std_deg), beside))


def _clusters(
    scenario: PeopleScenario,
    seen: BoolArray,
    bearing_rad: FloatArray,
    range_m: FloatArray,
    rng: np.random.Generator,
) -> _Rows:
    """People in the scan; arrays of shape (T, P)."""
    seen = seen & (rng.random(seen.shape) < scenario.scan_detection_probability)
    bearing_rad = bearing_rad + _CLUSTER_BEARING_STD_RAD * rng.standard_normal(seen.shape)
    measured_m = range_m + scenario.range_std_m * rng.standard_normal(seen.shape)
    count = np.count_nonzero(seen)
    std_rad, raised = np.full(count, _CLUSTER_BEARING_STD_RAD), np.zeros(count, dtype=bool)
    return _Rows(np.nonzero(seen)[0], bearing_rad[seen], measured_m[seen], std_rad, raised)


def _poses(scenario: PeopleScenario, yaw_rad: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Shape (T, 3): where the robot believes to be; it stands at the origin."""
    poses = np.empty((len(yaw_rad), 3))
    poses[:, :2] = scenario.pose_std_m * rng.standard_normal((len(yaw_rad), 2))
    poses[:, 2] = np.deg2rad(scenario.pose_std_deg) * rng.standard_normal(len(yaw_rad))
    poses[:, 2] += yaw_rad
    return poses


def _bias(
    scenario: PeopleScenario, scene: PeopleScene, measured: _Rows, poses: FloatArray
) -> FloatArray:
    """Shape (C, 2, 2): what lasts of the error of each place, as far as the robot can know it.

    Hands are up beside bodies, and a latency shifts everybody by as much as the robot turns
    meanwhile; how people walk meanwhile is not known. Both are across the line of sight.
    """
    at_s = scene.truth.stamps_ns / 1e9
    turn = np.gradient(scene.robot_yaw_rad, at_s) if len(at_s) > 1 else np.zeros(1)
    range_m = np.where(np.isnan(measured.range_m), 0.0, measured.range_m)
    late_m = scenario.latency_s * turn[measured.frame] * range_m
    across_m = np.hypot(np.where(measured.raised, scenario.hand_offset_m, 0.0), late_m)
    heading = measured.bearing_rad + poses[measured.frame, 2]
    left = across_m[:, None] * np.stack([-np.sin(heading), np.cos(heading)], axis=-1)
    return np.asarray(left[:, :, None] * left[:, None])


def _hidden(
    range_m: FloatArray, bearing_rad: FloatArray, width_m: float, rng: np.random.Generator
) -> BoolArray:
    """Shape (T, P): somebody nearer stands in the way."""
    half = np.arctan2(width_m / 2, np.where(np.isfinite(range_m), range_m, 1.0))
    apart = np.abs(normalize_angle(bearing_rad[:, :, None] - bearing_rad[:, None]))
    with np.errstate(invalid="ignore"):
        nearer = range_m[:, None, :] < range_m[:, :, None]
        covered = (nearer & (apart < half[:, None, :])).any(axis=-1)
    return covered & (rng.random(covered.shape) < _HIDDEN_SHARE) & (width_m > 0.0)


def _clutter(
    scenario: PeopleScenario, yaw_rad: FloatArray, rng: np.random.Generator
) -> tuple[_Rows, _Rows]:
    """Hands in view and clusters that are nobody, evenly over the area.

    Drawn frame after frame: how many numbers one frame takes decides what the next one gets.
    """
    means = scenario.clutter_per_frame, scenario.scan_clutter_per_frame
    counts = np.zeros((2, len(yaw_rad)), dtype=np.int64)
    drawn: tuple[list[FloatArray], list[FloatArray]] = ([], [])
    for frame in range(len(yaw_rad)):
        for kind, mean in enumerate(means):
            count = rng.poisson(mean)
            if count:
                counts[kind, frame] = count
                drawn[kind].append(rng.random((count, 2)))
    frames, bearing_rad, range_m = _places(scenario, counts[0], drawn[0], yaw_rad)
    in_view = np.abs(normalize_angle(bearing_rad)) <= np.deg2rad(scenario.field_of_view_deg) / 2
    frames, bearing_rad, range_m = frames[in_view], bearing_rad[in_view], range_m[in_view]
    raised, std_rad = np.ones(len(frames), dtype=bool), _hand_std_rad(scenario, range_m)
    hands = _Rows(frames, bearing_rad, range_m, std_rad, raised)
    frames, bearing_rad, range_m = _places(scenario, counts[1], drawn[1], yaw_rad)
    std_rad = np.full(len(frames), _CLUSTER_BEARING_STD_RAD)
    return hands, _Rows(frames, bearing_rad, range_m, std_rad, np.zeros(len(frames), dtype=bool))


def _places(
    scenario: PeopleScenario, counts: IntArray, drawn: list[FloatArray], yaw_rad: FloatArray
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Frame, bearing and range of numbers drawn from [0, 1), as many a frame as `counts` says."""
    frames = np.repeat(np.arange(len(counts)), counts)
    lower, upper = np.array(scenario.area_m[0::2]), np.array(scenario.area_m[1::2])
    xy = lower + (upper - lower) * np.concatenate([np.zeros((0, 2)), *drawn])
    bearing_rad = np.arctan2(xy[:, 1], xy[:, 0]) - yaw_rad[frames]
    return frames, bearing_rad, np.linalg.norm(xy, axis=-1)
