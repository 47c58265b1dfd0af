import numpy as np
import pytest

from tracker import Scan
from tracker.containers import OccupancyGrid
from tracker.geometry import RigidTransform
from tracker.ranging import RoomMap, find_people, locate_scan

LIMITS = {"segment_jump_m": 0.15, "leg_width_min_m": 0.02, "body_width_m": 0.8, "range_max_m": 8.0}


def room_with(*posts_m):
    """A map of cells of 5 cm, occupied at these points."""
    cells = np.zeros((160, 160), np.int8)
    for x, y in posts_m:
        cells[int((y + 4.0) / 0.05), int((x + 4.0) / 0.05)] = 100
    return RoomMap.of(OccupancyGrid(0, "map", 0.05, (-4.0, -4.0, 0.0), cells))


def test_a_leg_is_not_paired_with_a_post_of_the_map(cast):
    scan = cast([(2.0, 0.0, 0.06), (2.0, 0.35, 0.07)])
    (between,) = find_people(scan, **LIMITS).xy_m
    assert between == pytest.approx((2.0, 0.175), abs=0.03)
    on_map = [(2.0, 0.0), (1.95, 0.0), (2.0, 0.05), (2.0, -0.05)]
    people = find_people(scan, **LIMITS, room=room_with(*on_map))
    assert people.xy_m == pytest.approx(np.array([(2.0, 0.0), (2.0, 0.35)]), abs=0.03)
    post, leg = people.furniture_log_odds
    assert post > 2.0
    assert leg < 0.0


def test_a_leg_that_touches_a_post_is_one_piece_with_it_and_no_furniture(cast):
    touching = [(2.0, 0.0, 0.03), (2.0, 0.1, 0.07)]
    room = room_with((1.98, 0.0))
    (alone,) = find_people(cast(touching[:1]), **LIMITS, room=room).furniture_log_odds
    (together,) = find_people(cast(touching), **LIMITS, room=room).furniture_log_odds
    assert alone > 2.0
    assert together < 1.5


def test_what_stands_where_the_map_does_not_know_may_be_anybody(cast):
    room = RoomMap.of(OccupancyGrid(0, "map", 0.05, (5.0, 5.0, 0.0), np.zeros((9, 9), np.int8)))
    assert find_people(cast([(2.0, 0.0, 0.07)]), **LIMITS, room=room).furniture_log_odds == 0.0


def test_without_a_map_nothing_is_known_of_furniture(cast, legs):
    assert (find_people(cast(legs(2.0, 0.5)), **LIMITS).furniture_log_odds == 0.0).all()


def test_two_legs_are_one_person_between_them(cast, legs):
    people = find_people(cast(legs(2.0, 0.5)), **LIMITS)
    assert len(people) == 1
    assert people.xy_m[0] == pytest.approx([2.0, 0.5], abs=0.05)
    assert people.legs.tolist() == [2]


def test_somebody_across_the_seam_of_the_scan_is_not_cut_in_two(cast):
    people = find_people(cast([(2.0, 0.0, 0.2)]), **LIMITS)
    assert len(people) == 1
    assert people.xy_m[0] == pytest.approx([2.0, 0.0], abs=0.15)


def test_the_wall_is_nobody(cast):
    assert len(find_people(cast([]), **LIMITS)) == 0


@pytest.mark.parametrize("radius_m", [0.012, 0.02, 0.03], ids=str)
def test_a_slim_leg_is_somebody_where_three_beams_meet_it(cast, radius_m):
    (found,) = find_people(cast([(1.0, 0.3, radius_m)], beams=1440), **LIMITS).xy_m
    assert found == pytest.approx([1.0, 0.3], abs=0.07)
    assert len(find_people(cast([(4.0, 0.3, 0.03)], beams=360), **LIMITS)) == 0  # one beam


def test_what_is_thinner_than_a_leg_is_nobody(cast):
    assert len(find_people(cast([(1.0, 0.3, 0.004)], beams=7200), **LIMITS)) == 0
    limits = {**LIMITS, "leg_width_min_m": 0.075}
    assert len(find_people(cast([(1.0, 0.3, 0.02)]), **limits)) == 0


@pytest.mark.parametrize("width_m", [0.3, 0.6], ids=str)
def test_a_board_beside_something_else_is_nobody(cast, width_m):
    """A board at x = 2 whose right edge is hidden by a post, as behind a chair."""
    post = cast([(1.5, 0.15, 0.05)])
    beams = np.arange(720) * np.pi / 360
    board = 2.0 / np.where(np.cos(beams) > 0.1, np.cos(beams), 0.1)
    left = board * np.sin(beams)
    is_board = (np.cos(beams) > 0.1) & (left > 0.2) & (left < 0.2 + width_m)
    ranges = np.where(is_board, np.minimum(post.range_m, board), post.range_m)
    scan = locate_scan(Scan(0, "laser", 0.0, np.pi / 360, 0.05, 12.0, ranges), RigidTransform())
    people = find_people(scan, **LIMITS)
    assert people.xy_m == pytest.approx(np.array([[1.5, 0.15]]), abs=0.06)


def test_somebody_flat_who_stands_free_is_somebody():
    beams = np.arange(720) * np.pi / 360 - np.pi
    ranges = np.where(np.abs(beams) < 0.12, 2.0, 6.0)
    scan = locate_scan(Scan(0, "laser", -np.pi, np.pi / 360, 0.05, 12.0, ranges), RigidTransform())
    assert len(find_people(scan, **LIMITS)) == 1


def test_of_a_thousand_things_the_nearest_five_hundred_are_looked_at(cast):
    angles = np.arange(1000) * 2 * np.pi / 1000 + 0.003
    posts = [(3.0 * np.cos(a), 3.0 * np.sin(a), 0.005) for a in angles[10:]]
    scan = cast([(0.8, 0.0, 0.06), *posts], beams=14400)
    people = find_people(scan, **{**LIMITS, "leg_width_min_m": 0.0})
    assert 200 < len(people) <= 501
    assert np.min(np.linalg.norm(people.xy_m - [0.8, 0.0], axis=1)) < 0.05


def test_two_people_side_by_side_stay_two(cast, legs):
    people = find_people(cast(legs(2.0, -0.5) + legs(2.0, 0.5)), **LIMITS)
    assert sorted(people.xy_m[:, 1]) == pytest.approx([-0.5, 0.5], abs=0.06)


def test_positions_are_in_the_fixed_frame_whatever_the_laser_s_place_and_yaw(cast, legs):
    pose = np.array([1.0, -2.0, 2.5])
    people = find_people(cast(legs(2.0, 0.5), pose), **LIMITS)
    assert len(people) == 1
    assert people.xy_m[0] == pytest.approx([2.0, 0.5], abs=0.08)


def test_nobody_is_found_beyond_the_farthest_range(cast, legs):
    limits = {**LIMITS, "range_max_m": 1.5}
    assert len(find_people(cast(legs(2.0, 0.5)), **limits)) == 0


def test_single_lost_beams_do_not_part_a_leg(cast):
    holed = cast([(1.0, 0.0, 0.2)], lost=(10, -6))
    assert len(find_people(holed, **LIMITS)) == 1


def test_a_scan_of_nothing_but_infinity_holds_nobody(cast):
    scan = cast([], wall_m=np.inf)
    assert len(find_people(scan, **LIMITS)) == 0


def test_a_wall_that_runs_out_of_range_is_not_cut_down_to_a_person(cast):
    angles = np.arange(720) * np.pi / 360
    wall = np.where(np.cos(angles) > 0.01, 7.99 / np.maximum(np.cos(angles), 0.01), 12.5)
    scan = locate_scan(Scan(0, "laser", 0.0, np.pi / 360, 0.05, 12.0, wall), RigidTransform())
    assert len(find_people(scan, **LIMITS)) == 0
