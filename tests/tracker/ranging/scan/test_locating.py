"""Oracle: a world of points; each beam's angle and range are told by scipy's rotations."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tracker import Scan
from tracker.geometry import RigidTransform
from tracker.ranging import beam_index, find_people, locate_scan, median_range

BEAMS = 720
STEP_RAD = 2 * np.pi / BEAMS
LIMITS = {"segment_jump_m": 0.15, "leg_width_min_m": 0.02, "body_width_m": 0.8, "range_max_m": 8.0}
MOUNTINGS = {
    "upright": (0, 0, 40),
    "roll of 180": (180, 0, 0),
    "roll of 180, turned": (180, 0, -110),
    "pitch of 180": (0, 180, 25),
    "pitched down": (0, 15, -30),
    "rolled and upside down": (170, 8, 60),
}


def pose(roll_deg, pitch_deg, yaw_deg, at_m=(0.4, -0.3, 0.9)):
    turn = Rotation.from_euler("ZYX", [yaw_deg, pitch_deg, roll_deg], degrees=True)
    return RigidTransform(at_m, tuple(turn.as_quat()))


def scan_of_post(x, y, mounting, radius=0.15, wall_m=6.0):
    """A vertical post in a round room on a floor, as a laser of any attitude sees it."""
    angle = STEP_RAD * np.arange(BEAMS)
    own = np.stack([np.cos(angle), np.sin(angle), np.zeros(BEAMS)], axis=-1)
    beam = Rotation.from_quat(mounting.quaternion_xyzw).apply(own)
    level = np.hypot(beam[:, 0], beam[:, 1])
    ahead = beam[:, :2] / level[:, None]
    to_post = np.array([x, y]) - mounting.translation_m[:2]
    along, across = ahead @ to_post, ahead[:, 0] * to_post[1] - ahead[:, 1] * to_post[0]
    hit = (np.abs(across) < radius) & (along > 0)
    distance = np.where(hit, along - np.sqrt(np.maximum(radius**2 - across**2, 0)), wall_m)
    with np.errstate(divide="ignore"):
        floor = np.where(beam[:, 2] < 0, mounting.translation_m[2] / -beam[:, 2], np.inf)
    ranges = np.minimum(distance / level, floor)
    return Scan(0, "laser", 0.0, STEP_RAD, 0.05, 12.0, ranges)


@pytest.mark.parametrize("angles", MOUNTINGS.values(), ids=MOUNTINGS)
def test_a_person_stands_where_they_stand_however_the_laser_is_mounted(angles):
    mounting = pose(*angles)
    located = locate_scan(scan_of_post(1.6, -0.9, mounting), mounting)
    (found,) = find_people(located, **LIMITS).xy_m
    assert found == pytest.approx([1.6, -0.9], abs=0.1)


@pytest.mark.parametrize("angles", MOUNTINGS.values(), ids=MOUNTINGS)
def test_a_heading_meets_the_beam_that_looks_along_it_however_the_laser_is_mounted(angles):
    mounting = pose(*angles)
    located = locate_scan(scan_of_post(1.6, -0.9, mounting), mounting)
    toward = np.arctan2(-0.9 + 0.3, 1.6 - 0.4)
    assert median_range(located, [toward])[0] == pytest.approx(np.hypot(0.6, 1.2) - 0.15, abs=0.01)
    beam = beam_index(located, [toward + 2 * np.pi])
    turn = located.heading_rad[beam] - toward
    assert np.cos(turn) == pytest.approx([1.0], abs=1e-3)


def test_equation_11_names_the_same_beam_upside_down_and_upright():
    ranges = 1.0 + 0.01 * np.arange(181)
    upright = Scan(0, "laser", -np.pi / 2, np.radians(1.0), 0.1, 9.0, ranges)
    above = locate_scan(upright, RigidTransform())
    below = locate_scan(upright, pose(180, 0, 0, at_m=(0, 0, 1)))
    headings = np.radians([-60.0, 0.0, 31.0])
    assert beam_index(above, headings).tolist() == [30, 90, 121]
    assert beam_index(below, -headings).tolist() == [30, 90, 121]


def test_the_span_is_that_of_the_fixed_frame():
    half = Scan(0, "laser", -1.0, 0.1, 0.1, 9.0, np.ones(31))  # from -1 to 2
    right, left = locate_scan(half, RigidTransform.from_planar(5.0, 5.0, 0.5)).span_rad
    assert (right, left) == pytest.approx((-0.55, 2.55))
    right, left = locate_scan(half, pose(180, 0, 0)).span_rad
    assert (right, left) == pytest.approx((-2.05, 1.05))


def test_beams_that_meet_the_floor_or_pass_over_heads_are_nobody():
    mounting = pose(0, 20, 0, at_m=(0.0, 0.0, 0.3))
    down = 0.3 / np.sin(np.radians(20.0))  # straight ahead this far to the floor
    on_floor = Scan(0, "laser", 0.0, np.pi / 2, 0.1, 9.0, [down, 1.0, 1.0, 1.0])
    assert locate_scan(on_floor, mounting).valid.tolist() == [False, True, True, True]
    over_heads = Scan(0, "laser", 0.0, np.pi / 2, 0.1, 9.0, [0.5, 1.0, 6.5, 1.0])
    up = locate_scan(over_heads, mounting)
    assert up.valid.tolist() == [True, True, False, True]


def test_a_level_scanner_whose_transform_tells_no_height_sees_people():
    located = locate_scan(Scan(0, "laser", 0.0, 0.1, 0.1, 9.0, np.ones(9)), RigidTransform())
    assert located.valid.all()


def test_infinity_shows_that_nothing_is_there_and_nan_or_zero_show_nothing_at_all():
    ranges = [np.inf, 12.0, np.nan, 0.0, -1.0, -np.inf, 0.01, 2.0]
    located = locate_scan(Scan(0, "laser", 0.0, 0.1, 0.0, 9.0, ranges), RigidTransform())
    known = [np.inf, np.inf, np.nan, np.nan, np.nan, np.nan, 0.01, 2.0]
    np.testing.assert_array_equal(located.range_m, known)
    assert located.valid.tolist() == [False] * 6 + [True, True]


def test_beams_are_turned_by_the_robot_s_motion_within_the_scan():
    increment_s = 0.1 / (BEAMS - 1)
    rate_radps, speed_mps = 1.2, 0.8
    share = np.arange(BEAMS) / (BEAMS - 1)
    yaw = rate_radps * 0.1 * share + STEP_RAD * np.arange(BEAMS)
    x = speed_mps * 0.1 * share
    # Walls at x = 3, seen by a robot that drives toward it and turns.
    with np.errstate(divide="ignore"):
        ranges = np.where(np.cos(yaw) > 0.05, (3.0 - x) / np.cos(yaw), np.inf)
    scan = Scan(5_000, "laser", 0.0, STEP_RAD, 0.05, 30.0, ranges, time_increment_s=increment_s)
    assert scan.end_ns == 5_000 + 100_000_000
    start = RigidTransform.from_planar(0.0, 0.0, 0.0)
    end = RigidTransform.from_planar(0.08, 0.0, 0.12)
    seen = locate_scan(scan, start, end)
    assert seen.returns_m()[:, 0] == pytest.approx(3.0, abs=2e-3)
    assert seen.laser_xy_m == pytest.approx([0.04, 0.0])
    still = locate_scan(scan, start)
    assert np.abs(still.returns_m()[:, 0] - 3.0).max() > 0.3


@pytest.mark.parametrize("increment_s", [0.0, -1e-4, np.nan, 0.5], ids=str)
def test_a_scan_whose_time_increment_makes_no_sense_is_one_instant(increment_s):
    scan = Scan(7, "laser", 0.0, 0.1, 0.1, 9.0, np.ones(60), time_increment_s=increment_s)
    assert scan.end_ns == 7


def test_a_map_whose_origin_is_far_away_changes_no_distance():
    far = RigidTransform.from_planar(467_000.5, 5_540_000.25, 0.3)
    scan = scan_of_post(1.2, 0.5, RigidTransform.from_planar(0.0, 0.0, 0.3, 0.2))
    (found,) = find_people(locate_scan(scan, far), **LIMITS).xy_m
    assert found - [467_000.5, 5_540_000.25] == pytest.approx([1.2, 0.5], abs=0.1)
