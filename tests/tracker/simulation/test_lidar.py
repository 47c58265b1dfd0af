import numpy as np
import pytest

from tracker.geometry import RigidTransform
from tracker.simulation import scene_from_mapping
from tracker.simulation.legs import table_posts
from tracker.simulation.lidar import ScanSimulator, cast_rays
from tracker.simulation.motion import people_at

NOTHING = np.zeros((0, 3)), np.zeros((0, 4))


def test_a_ray_meets_the_near_side_of_a_circle():
    circle = np.array([[3.0, 0.0, 0.5]])
    ranges = cast_rays((0.0, 0.0), np.radians([0.0, 5.0, 90.0, 180.0]), circle, NOTHING[1])
    # At 5 degrees: 3 cos 5 - sqrt(0.25 - (3 sin 5)^2) = 2.988584 - 0.426187.
    np.testing.assert_allclose(ranges, [2.5, 2.562398, np.inf, np.inf], atol=1e-5)


def test_a_ray_meets_a_wall_only_between_its_ends():
    wall = np.array([[2.0, -1.0, 2.0, 1.0]])
    angles = np.arctan2([0.0, 0.99, 1.01, 0.0], [2.0, 2.0, 2.0, -2.0])
    ranges = cast_rays((0.0, 0.0), angles, NOTHING[0], wall)
    np.testing.assert_allclose(ranges, [2.0, np.hypot(2.0, 0.99), np.inf, np.inf])


def test_the_nearer_thing_hides_the_farther():
    circles = np.array([[4.0, 0.0, 0.1], [2.0, 0.0, 0.1]])
    wall = np.array([[5.0, -1.0, 5.0, 1.0]])
    assert cast_rays((0.0, 0.0), np.zeros(1), circles, wall) == pytest.approx(1.9)


def test_a_ray_along_a_wall_does_not_meet_it():
    wall = np.array([[1.0, 0.0, 2.0, 0.0]])
    assert np.isinf(cast_rays((0.0, 0.0), np.zeros(1), NOTHING[0], wall)).all()


def test_an_empty_world_gives_no_return():
    assert np.isinf(cast_rays((0.0, 0.0), np.zeros(3), *NOTHING)).all()


@pytest.mark.parametrize("first_beam_deg", [0.0, -180.0])
@pytest.mark.parametrize("yaw_deg", [0.0, 90.0, 180.0])
def test_the_scan_sees_a_leg_where_it_is(room, first_beam_deg, yaw_deg):
    room["walls"], room["tables"], room["people"] = [], [], room["people"][1:]
    room["laser"] = {"noise_m": 0.0, "dropout": 0.0, "first_beam_deg": first_beam_deg}
    scene = scene_from_mapping(room)
    pose = RigidTransform.from_planar(0.2, 0.1, np.radians(yaw_deg))
    people = people_at(scene, 0.0)
    scan = ScanSimulator(scene, np.random.default_rng(0)).scan(7, pose, people)
    assert len(scan.ranges_m) == 720
    hit = np.flatnonzero(scan.valid)
    bearing = scan.angles_rad[hit] + np.radians(yaw_deg)
    points = np.stack([np.cos(bearing), np.sin(bearing)], -1) * scan.ranges_m[hit, None]
    points += (0.2, 0.1)
    away = np.linalg.norm(points[:, None] - people.legs[0, None, :, :2], axis=-1).min(axis=1)
    np.testing.assert_allclose(away, 0.07, atol=1e-9)


def test_tables_stand_on_one_post_on_two_along_them_or_on_four():
    turned = {"x_m": 1.0, "y_m": 2.0, "yaw_deg": 90.0, "length_m": 1.4, "width_m": 0.8}
    one, two, four = (
        table_posts(scene_from_mapping({"duration_s": 1.0, "tables": [table]}).tables[0])
        for table in (turned | {"posts": count} for count in (1, 2, 4))
    )
    np.testing.assert_allclose(one[:, :2], [[1.0, 2.0]])
    np.testing.assert_allclose(two[:, :2], [[1.0, 2.55], [1.0, 1.45]])
    assert np.ptp(four[:, 0]) == pytest.approx(0.7)
    assert np.ptp(four[:, 1]) == pytest.approx(1.3)


def test_legs_of_a_round_table_stand_under_it():
    table = {"length_m": 0.8, "width_m": 0.8, "round": True}
    (table,) = scene_from_mapping({"duration_s": 1.0, "tables": [table]}).tables
    assert (np.hypot(*table_posts(table)[:, :2].T) < 0.4).all()


def test_the_scan_sees_four_legs_of_a_chair_and_the_column_of_a_bar_stool(room):
    room["walls"], room["tables"], room["people"] = [], [], []
    room["laser"] = {"noise_m": 0.0, "dropout": 0.0, "step_deg": 0.1}
    room["chairs"] = [{"x_m": 2.0, "y_m": 0.0, "yaw_deg": 20.0}]
    room["chairs"] += [{"kind": "bar_stool", "x_m": 0.0, "y_m": 2.0}]
    scene = scene_from_mapping(room)
    scanner = ScanSimulator(scene, np.random.default_rng(0))
    hit = scanner.scan(7, RigidTransform(), people_at(scene, 0.0)).valid
    assert np.count_nonzero(np.diff(np.flatnonzero(hit)) > 1) == 4  # five pieces


def test_noise_and_dropouts_are_as_large_as_asked(room):
    room["people"], room["tables"] = [], []
    room["laser"] = {"noise_m": 0.03, "dropout": 0.1, "step_deg": 0.1}
    noisy = scene_from_mapping(room)
    room["laser"] = {"noise_m": 0.0, "dropout": 0.0, "step_deg": 0.1}
    clean = scene_from_mapping(room)
    people, pose = people_at(noisy, 0.0), RigidTransform()
    scan = ScanSimulator(noisy, np.random.default_rng(1)).scan(0, pose, people)
    truth = ScanSimulator(clean, np.random.default_rng(1)).scan(0, pose, people)
    lost = np.isinf(scan.ranges_m)
    assert lost.mean() == pytest.approx(0.1, abs=0.02)
    error = scan.ranges_m[~lost] - truth.ranges_m[~lost]
    assert error.std() == pytest.approx(0.03, rel=0.05)
    assert abs(error.mean()) < 0.002


def test_walls_beyond_the_scanners_range_give_no_return(room):
    room["laser"] = {"range_max_m": 1.0, "dropout": 0.0}
    room["people"], room["tables"] = [], []
    scene = scene_from_mapping(room)
    scan = ScanSimulator(scene, np.random.default_rng(0)).scan(
        0, RigidTransform(), people_at(scene, 0.0)
    )
    assert np.isinf(scan.ranges_m).all()


def test_table_posts_stand_at_its_corners(room):
    room["tables"] = [{"x_m": 1.0, "y_m": 2.0, "length_m": 1.1, "width_m": 0.5, "yaw_deg": 90.0}]
    posts = table_posts(scene_from_mapping(room).tables[0])
    expected = {(0.8, 2.5), (1.2, 2.5), (0.8, 1.5), (1.2, 1.5)}
    assert {(round(x, 6), round(y, 6)) for x, y, _ in posts} == expected
