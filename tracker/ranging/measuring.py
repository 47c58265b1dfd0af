"""What do hands and scan together claim about people? Measurements with honest covariance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracker.camera import CameraModel
from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, Hands, IntArray, LocatedScan, Measurements
from tracker.geometry import RigidTransform, normalize_angle
from tracker.ranging.background import Background
from tracker.ranging.depth import HandDepths
from tracker.ranging.hand_pairs import pair_hands
from tracker.ranging.people import PersonClusters, find_people
from tracker.ranging.person_range import owners
from tracker.ranging.ray_range import range_along_rays
from tracker.ranging.rays import HandRays, hand_rays

#: A body so wide or near that its bearing could be any: that of an even spread over the circle.
_BEARING_STD_MAX_RAD = float(np.pi / np.sqrt(3.0))
_RANGE_MIN_M = 0.05
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
    background: Background | None = None,
    people: PersonClusters | None = None,
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
        background: What has been learnt of the room so far, and learns from this scan; None takes
            whatever is person-sized for a person.
        people: From `scan_people`, where that has been asked already.
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
    is_background = np.zeros(len(people), dtype=bool)
    if background is not None and scan is not None:
        if sustain:
            background.observe(scan, people, config.background_after_s)
        is_background = background.holds(people.xy_m)
    if config.ranging == "spec":
        claimed = np.full(len(hands), -1, dtype=np.int64)
        range_m = np.full(len(hands), np.nan)
        if scan is not None:
            range_m = range_along_rays(rays, scan, config.scan_window_beams, config.segment_jump_m)
    else:
        claimed = owners(rays, hands, camera, people, is_background, config.arm_reach_m)
        range_m = np.full(len(hands), np.nan)

    range_std_m = np.full(len(hands), config.range_std_m)
    if depths is not None:
        range_m = np.where(depths.is_known, depths.range_m, range_m)
        range_std_m = np.where(depths.is_known, depths.std_m, range_std_m)
        claimed = np.where(depths.is_known, -1, claimed)
        bearing_rad = np.where(depths.is_known, depths.bearing_rad, rays.bearing_rad)
        rays = replace(rays, bearing_rad=bearing_rad)
    seen = claimed >= 0
    alone = np.flatnonzero(~seen & np.isfinite(rays.bearing_rad))
    from_hands = _hand_measurements(alone, rays, range_m, range_std_m, hands, pair, config)
    if seen.any():
        # The body itself is measured: the ray has only said which of them it is.
        of_bodies = _body_measurements(
            people.xy_m[claimed[seen]],
            rays.origin,
            config,
            raised=hands.raised[seen],
            person=claimed[seen],
            hand=np.flatnonzero(seen),
        )
        from_hands = Measurements.concatenate(from_hands, of_bodies)
    callers = claimed[hands.raised & seen]
    if background is not None:
        background.free(people.xy_m[callers])
    if not sustain or not config.scan_sustains or len(people) == 0:
        return from_hands
    # Whom a hand stands for, up or not, is not measured twice: the second would be a twin.
    free = np.setdiff1d(np.flatnonzero(~is_background), claimed[seen])
    from_scan = _body_measurements(
        people.xy_m[free], rays.origin, config, raised=False, person=free, hand=-1
    )
    return Measurements.concatenate(from_hands, from_scan)


def scan_people(scan: LocatedScan | None, config: Config) -> PersonClusters:
    """`find_people` by the configured lengths; nobody where there is no scan."""
    if scan is None:
        return PersonClusters.none()
    return find_people(
        scan,
        segment_jump_m=config.segment_jump_m,
        leg_width_min_m=config.leg_width_min_m,
        body_width_m=config.body_width_m,
        range_max_m=config.person_range_max_m,
    )


def _hand_measurements(
    rows: IntArray,
    rays: HandRays,
    range_m: FloatArray,
    range_std_m: FloatArray,
    hands: Hands,
    pair: IntArray,
    config: Config,
) -> Measurements:
    """The hand's own ray; the body stands somewhere beside it, closer to that of its torso."""
    supposed_m = np.where(np.isnan(range_m), config.unknown_range_m, range_m)
    offset_m = np.where(hands.is_owned, config.torso_offset_std_m, config.hand_offset_std_m)
    offset_std = np.arctan2(offset_m, np.maximum(supposed_m, 0.3))
    return Measurements.polar(
        rays.bearing_rad[rows],
        range_m[rows],
        np.hypot(rays.bearing_std_rad, offset_std)[rows],
        range_std_m[rows],
        rays.origin,
        raised=hands.raised[rows],
        person=pair[rows],
        hand=rows,
        refuse="drop",
    )


def _body_measurements(
    xy_m: FloatArray,
    origin: FloatArray,
    config: Config,
    *,
    raised: BoolArray | bool,
    person: IntArray,
    hand: IntArray | int,
) -> Measurements:
    """Person clusters as bearing and range from the camera, noise alike in both directions."""
    offset = xy_m - origin[:2]
    range_m = np.maximum(np.hypot(offset[:, 0], offset[:, 1]), _RANGE_MIN_M)
    bearing = normalize_angle(np.arctan2(offset[:, 1], offset[:, 0]) - origin[2])
    return Measurements.polar(
        bearing,
        range_m,
        body_bearing_std_rad(range_m, config.range_std_m),
        config.range_std_m,
        origin,
        raised=raised,
        person=person,
        hand=hand,
        refuse="drop",
    )


def body_bearing_std_rad(range_m: FloatArray, std_m: float) -> FloatArray:
    """Bearing noise of bodies that a scan has shown to the same length in both directions.

    Args:
        range_m: Shape (M,).
        std_m: Standard deviation of their place, along and across.
    """
    return np.minimum(std_m / np.maximum(range_m, _RANGE_MIN_M), _BEARING_STD_MAX_RAD)
