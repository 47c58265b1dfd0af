"""What the sensors make of a scene: noisy, late, blind at times, seeing things at others."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from tracker.containers import BoolArray, FloatArray, Measurements
from tracker.evaluation.trials.people_scene import PeopleScene
from tracker.evaluation.trials.scenario import PeopleScenario
from tracker.geometry import normalize_angle
from tracker.tracking.view import View

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


def sense(
    scenario: PeopleScenario, scene: PeopleScene, rng: np.random.Generator
) -> Iterator[Sensed]:
    """Measure a scene, frame by frame.

    Args:
        scenario: Noise and faults.
        scene: What is there to be seen.
        rng: All randomness; drawn in the same order whatever the frames show.

    Yields:
        Each frame in turn.
    """
    xy = scene.shown_xy_m
    range_m = np.linalg.norm(xy, axis=-1)
    bearing = np.arctan2(xy[..., 1], xy[..., 0]) - scene.shown_yaw_rad[:, None]
    there = np.isfinite(range_m) & (range_m > 0.3)
    seen = there & ~_hidden(range_m, bearing, scenario.body_width_m, rng)

    hand_seen = seen & scene.hand_up & scene.in_view
    hand_seen &= rng.random(hand_seen.shape) < scenario.detection_probability
    beside = np.arctan2(scenario.hand_offset_m * scene.hand_side, np.where(there, range_m, 1.0))
    noise_rad = np.deg2rad(scenario.bearing_std_deg)
    hand_bearing = bearing + beside + noise_rad * rng.standard_normal(bearing.shape)
    hand_range = range_m + scenario.range_std_m * rng.standard_normal(range_m.shape)
    off = rng.random(range_m.shape) < scenario.outlier_share
    hand_range += np.where(off, scenario.outlier_m * rng.random(range_m.shape), 0.0)
    hand_range[rng.random(range_m.shape) < scenario.range_missing_share] = np.nan
    hand_std = np.hypot(noise_rad, np.arctan2(scenario.hand_offset_m, range_m))

    cluster_seen = seen & (rng.random(seen.shape) < scenario.scan_detection_probability)
    cluster_bearing = bearing + _CLUSTER_BEARING_STD_RAD * rng.standard_normal(bearing.shape)
    cluster_range = range_m + scenario.range_std_m * rng.standard_normal(range_m.shape)

    poses = np.zeros((len(xy), 3))
    poses[:, :2] = scenario.pose_std_m * rng.standard_normal((len(xy), 2))
    poses[:, 2] = np.deg2rad(scenario.pose_std_deg) * rng.standard_normal(len(xy))
    poses[:, 2] += scene.robot_yaw_rad
    pose_std = [scenario.pose_std_m, scenario.pose_std_m, np.deg2rad(scenario.pose_std_deg)]
    pose_covariance = np.diag(np.square(pose_std))
    view_rad = float(np.deg2rad(scenario.field_of_view_deg))
    for frame, pose in enumerate(poses):
        hands, clusters = hand_seen[frame], cluster_seen[frame]
        false_hands = _clutter(scenario, rng, scenario.clutter_per_frame)
        false_clusters = _clutter(scenario, rng, scenario.scan_clutter_per_frame)
        false_hands[:, 0] -= scene.shown_yaw_rad[frame]
        false_clusters[:, 0] -= scene.shown_yaw_rad[frame]
        in_view = np.abs(normalize_angle(false_hands[:, 0])) <= view_rad / 2
        false_hands = false_hands[in_view]
        false_std = np.hypot(noise_rad, np.arctan2(scenario.hand_offset_m, false_hands[:, 1]))
        measured = Measurements.concatenate(
            Measurements.polar(
                normalize_angle(np.append(hand_bearing[frame, hands], false_hands[:, 0])),
                np.maximum(np.append(hand_range[frame, hands], false_hands[:, 1]), 0.05),
                np.append(hand_std[frame, hands], false_std),
                scenario.range_std_m,
                pose,
            ),
            Measurements.polar(
                normalize_angle(np.append(cluster_bearing[frame, clusters], false_clusters[:, 0])),
                np.maximum(np.append(cluster_range[frame, clusters], false_clusters[:, 1]), 0.05),
                _CLUSTER_BEARING_STD_RAD,
                scenario.range_std_m,
                pose,
                raised=False,
            ),
        )
        known = np.broadcast_to(pose_covariance, (len(measured), 3, 3))
        yield Sensed(
            replace(measured, sensor_pose_covariance=known),
            View(pose, view_rad),
            View(pose, 2 * np.pi) if scenario.scan_detection_probability else None,
        )


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


def _clutter(scenario: PeopleScenario, rng: np.random.Generator, mean: float) -> FloatArray:
    """Bearing and range of what is nobody, evenly over the area; shape (C, 2)."""
    x_from, x_to, y_from, y_to = scenario.area_m
    xy = rng.uniform((x_from, y_from), (x_to, y_to), (rng.poisson(mean), 2))
    return np.stack([np.arctan2(xy[:, 1], xy[:, 0]), np.linalg.norm(xy, axis=-1)], axis=-1)
