"""Hands and scan to measurements of people, with their covariance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracker.camera import CameraModel
from tracker.config import Config
from tracker.containers import (
    BoolArray,
    FloatArray,
    Hands,
    IntArray,
    LocatedScan,
    Measurements,
    Tracks,
)
from tracker.geometry import RigidTransform, normalize_angle
from tracker.ranging.bias import bias_covariance
from tracker.ranging.depth import HandDepths
from tracker.ranging.hand_pairs import pair_hands
from tracker.ranging.memory import Memory
from tracker.ranging.person_range import BESIDE_M
from tracker.ranging.ray_range import range_along_rays
from tracker.ranging.rays import HandRays, hand_rays
from tracker.ranging.scan.background import Background
from tracker.ranging.scan.people import PersonClusters, find_people
from tracker.ranging.scan.room_map import RoomMap

#: A body so wide or near that its bearing could be any: that of an even spread over the circle.
_BEARING_STD_MAX_RAD = float(np.pi / np.sqrt(3.0))
_RANGE_MIN_M = 0.05
#: What the map says to be furniture with more than these log-odds sustains nobody, and owns a hand
#: only where nobody else fits it (guess).
_MAPPED_LOG_ODDS = 1.5
#: Who sits has the middle of the body so far behind what the laser sees at the height of shins, on
#: average: a quarter of a meter of those who face the robot, nothing of those beside a table. So
#: much lasts of the spread, and so much differs from scan to scan, as table legs show (guesses).
_SEATED_BACK_M, _SEATED_STD_M, _SEATED_NOISE_M = 0.1, 0.12, 0.08
_STILL = np.zeros(3)
#: Numbers of picture pairs (`Measurements.person`) start here, above any cluster's row.
_PAIR_OFFSET = 1_000_000


def measure_people(
    hands: Hands,
    camera: CameraModel,
    fixed_from_camera: RigidTransform,
    scan: LocatedScan | None,
    config: Config,
    *,
    sustain: bool = True,
    people: PersonClusters | None = None,
    motion: FloatArray = _STILL,
    memory: Memory | None = None,
    tracked: Tracks | None = None,
    stamp_ns: int = 0,
    depths: HandDepths | None = None,
) -> Measurements:
    """Turn one image's hands and the scan beside it into measurements in the fixed frame.

    Args:
        hands: What perception found.
        camera: Intrinsics of the full image.
        fixed_from_camera: The camera with body axes in the fixed frame, at the image's stamp.
        scan: The scan nearest to the image in time, located at its own stamp; None where there is
            none.
        config: The ranging group.
        sustain: Whether the scan's other person clusters are measurements too. One scan may serve
            several images; it speaks for itself only once.
        people: From `scan_people`, where that has been asked already.
        motion: Shape (3,): x_mps, y_mps, yaw_radps of camera and laser in the fixed frame.
        memory: What earlier images and scans told, which learns from these; None judges by these
            alone, and takes whatever is person-sized for a person.
        tracked: Everybody known at the last image; None means nobody.
        stamp_ns: The image's.
        depths: What a depth camera says of hands' owners; it shows whose hand it is as well, so
            that the scan is not asked for those it knows.

    Returns:
        First one row for each hand whose direction is known, then the clusters that no hand has
        claimed and that are no background. Rows that no tracker could use are left out.
    """
    rays = hand_rays(hands, camera, fixed_from_camera, config)
    pair = pair_hands(hands)
    pair = np.where(pair >= 0, pair + _PAIR_OFFSET, -1)
    if people is None:
        people = scan_people(scan, config)
    memory = Memory() if memory is None else memory
    background = memory.background if config.background_after_s > 0.0 else Background()
    if sustain and scan is not None and config.background_after_s > 0.0:
        background.observe(scan, people, config.background_after_s)
    is_background = people.furniture_log_odds > _MAPPED_LOG_ODDS
    is_background |= background.holds(people.xy_m)
    side, range_m = np.zeros(len(hands)), np.full(len(hands), np.nan)
    range_std_m = np.full(len(hands), config.range_std_m)
    claimed = np.full(len(hands), -1, dtype=np.int64)
    if config.ranging == "spec":
        if scan is not None:
            range_m = range_along_rays(rays, scan, config.scan_window_beams, config.segment_jump_m)
    else:
        owners = memory.ownership.judge(
            hands, rays, camera, people, background,
            Tracks.none(stamp_ns) if tracked is None else tracked, stamp_ns, config,
        )  # fmt: skip
        claimed, side = owners.cluster, owners.side
        range_m, range_std_m = owners.range_m, owners.range_std_m
    beside_m = BESIDE_M * side
    if depths is not None:
        range_m = np.where(depths.is_known, depths.range_m, range_m)
        range_std_m = np.where(depths.is_known, depths.std_m, range_std_m)
        claimed = np.where(depths.is_known, -1, claimed)
        bearing_rad = np.where(depths.is_known, depths.bearing_rad, rays.bearing_rad)
        rays = replace(rays, bearing_rad=bearing_rad)
        beside_m = np.where(depths.is_known, 0.0, beside_m)
    seated = memory.postures.at(people.xy_m, config.same_person_distance_m)
    seen = claimed >= 0
    alone = np.flatnonzero(~seen & np.isfinite(rays.bearing_rad))
    from_hands = _hand_measurements(
        alone, rays, beside_m, range_m, range_std_m, hands, pair, motion, config
    )
    if seen.any():
        # The body itself is measured: the ray has only said which of them it is.
        of_bodies = _body_measurements(
            people.xy_m[claimed[seen]],
            rays.origin,
            motion,
            config,
            raised=hands.raised[seen],
            person=claimed[seen],
            hand=np.flatnonzero(seen),
            seated=np.where(
                np.isnan(hands.seated[seen]), seated[claimed[seen]], hands.seated[seen]
            ),
        )
        from_hands = Measurements.concatenate(from_hands, of_bodies)
    background.free(people.xy_m[claimed[hands.raised & seen]])
    if not sustain or not config.scan_sustains or len(people) == 0:
        return from_hands
    # Whom a hand stands for, up or not, is not measured twice: the second would be a twin.
    free = np.setdiff1d(np.flatnonzero(~is_background), claimed[seen])
    from_scan = _body_measurements(
        people.xy_m[free],
        rays.origin,
        motion,
        config,
        raised=False,
        person=free,
        hand=-1,
        seated=seated[free],
    )
    return Measurements.concatenate(from_hands, from_scan)


def scan_people(
    scan: LocatedScan | None, config: Config, room: RoomMap | None = None
) -> PersonClusters:
    """`find_people` by the configured lengths; nobody where there is no scan."""
    if scan is None:
        return PersonClusters.none()
    return find_people(
        scan,
        segment_jump_m=config.segment_jump_m,
        leg_width_min_m=config.leg_width_min_m,
        body_width_m=config.body_width_m,
        range_max_m=config.person_range_max_m,
        room=room,
    )


def _hand_measurements(
    rows: IntArray,
    rays: HandRays,
    beside_m: FloatArray,
    range_m: FloatArray,
    range_std_m: FloatArray,
    hands: Hands,
    pair: IntArray,
    motion: FloatArray,
    config: Config,
) -> Measurements:
    """The hand's own ray; the body stands somewhere beside it, closer to that of its torso."""
    supposed_m = np.where(np.isnan(range_m), config.unknown_range_m, range_m)
    offset_m = np.where(hands.is_owned, config.torso_offset_std_m, config.hand_offset_std_m)
    offset_std = np.arctan2(offset_m, np.maximum(supposed_m, 0.3))
    bearing = rays.bearing_rad + np.arctan2(beside_m, np.maximum(supposed_m, 0.3))
    std_m = np.where(np.isnan(range_m), config.range_std_m, range_std_m)
    heading = rays.bearing_rad[rows] + rays.origin[2]
    bias = bias_covariance(
        heading,
        supposed_m[rows],
        config,
        along_m=config.torso_offset_std_m,
        across_m=offset_m[rows],
        motion=motion,
    )
    return Measurements.polar(
        normalize_angle(bearing)[rows],
        range_m[rows],
        np.hypot(rays.bearing_std_rad, offset_std)[rows],
        std_m[rows],
        rays.origin,
        raised=hands.raised[rows],
        person=pair[rows],
        hand=rows,
        sensor_pose_covariance=_pose_covariance(motion, config),
        bias_covariance=bias,
        refuse="drop",
    )


def _body_measurements(
    xy_m: FloatArray,
    origin: FloatArray,
    motion: FloatArray,
    config: Config,
    *,
    raised: BoolArray | bool,
    person: IntArray,
    hand: IntArray | int,
    seated: FloatArray,
) -> Measurements:
    """Person clusters as bearing and range from the camera, noise alike in both directions.

    Of somebody who sits the laser sees shins, and legs of table and chair among them.
    """
    sits = np.nan_to_num(seated, nan=0.0)
    offset = xy_m - origin[:2]
    range_m = np.maximum(np.hypot(offset[:, 0], offset[:, 1]), _RANGE_MIN_M)
    heading = np.arctan2(offset[:, 1], offset[:, 0])
    across_m = np.hypot(config.torso_offset_std_m, np.sqrt(sits) * _SEATED_STD_M)
    along_m = np.hypot(across_m, np.sqrt(sits * (1.0 - sits)) * _SEATED_BACK_M)
    bias = bias_covariance(
        heading, range_m, config, along_m=along_m, across_m=across_m, motion=motion
    )
    std_m = np.hypot(config.range_std_m, np.sqrt(sits) * _SEATED_NOISE_M)
    range_m = range_m + sits * _SEATED_BACK_M
    return Measurements.polar(
        normalize_angle(heading - origin[2]),
        range_m,
        body_bearing_std_rad(range_m, std_m),
        std_m,
        origin,
        raised=raised,
        person=person,
        hand=hand,
        sensor_pose_covariance=_pose_covariance(motion, config),
        bias_covariance=bias,
        refuse="drop",
    )


def _pose_covariance(motion: FloatArray, config: Config) -> FloatArray | None:
    """Shape (3, 3): pose error by wrong stamps; the same for both sensors, which move together."""
    moved = config.stamp_std_s * motion
    return np.outer(moved, moved) if moved.any() else None


def is_told_by_size(measurements: Measurements) -> BoolArray:
    """Shape (M,): hands in a picture for whose owner no cluster stands."""
    is_body = (measurements.person >= 0) & (measurements.person < _PAIR_OFFSET)
    return np.asarray((measurements.hand >= 0) & ~is_body)


def body_bearing_std_rad(range_m: FloatArray, std_m: FloatArray | float) -> FloatArray:
    """Bearing noise for bodies of the scan, whose error is equal in both directions.

    Args:
        range_m: Shape (M,).
        std_m: Standard deviation of their place, along and across; shape (M,) or one number.
    """
    return np.minimum(std_m / np.maximum(range_m, _RANGE_MIN_M), _BEARING_STD_MAX_RAD)
