import numpy as np
import pytest

from tracker.containers import OccupancyGrid
from tracker.geometry import RigidTransform
from tracker.ranging import RoomMap


def grid_of(cells, resolution_m=0.1, origin=(0.0, 0.0, 0.0)):
    return OccupancyGrid(0, "map", resolution_m, origin, np.array(cells, np.int8))


def with_post(row=10, column=20, shape=(30, 40), **more):
    cells = np.zeros(shape, np.int8)
    cells[row, column] = 100
    return grid_of(cells, **more)


def test_distances_equal_those_to_every_occupied_cell():
    rng = np.random.default_rng(1)
    cells = np.where(rng.random((30, 40)) < 0.02, 100, 0)
    room = RoomMap.of(grid_of(cells, origin=(-1.0, 2.0, 0.0)))
    rows, columns = np.nonzero(cells)
    middles = np.stack([columns, rows], axis=-1) * 0.1 + 0.05 + (-1.0, 2.0)
    row, column = rng.integers(0, 30, 50), rng.integers(0, 40, 50)
    asked = np.stack([column, row], axis=-1) * 0.1 + 0.05 + (-1.0, 2.0)
    nearest = np.linalg.norm(asked[:, None] - middles, axis=-1).min(axis=1)
    assert room.distance_m(asked) == pytest.approx(nearest, abs=1e-6)


def test_a_map_that_is_turned_is_asked_in_its_own_frame():
    room = RoomMap.of(with_post(origin=(3.0, 1.0, np.pi / 2)))
    # The grid's x axis is the map's y axis, its y axis the map's -x axis.
    post = np.array([[3.0 - 1.05, 1.0 + 2.05]])
    assert room.distance_m(post) == pytest.approx(0.0)
    assert room.distance_m(post + np.array([0.0, 0.5])) == pytest.approx(0.5)


def test_points_of_another_frame_are_asked_by_its_transform():
    room, post = RoomMap.of(with_post()), np.array([2.05, 1.05, 0.0])
    map_from_odom = RigidTransform.from_planar(0.5, -0.2, 0.7)
    there = map_from_odom.inverse().apply(post)[None, :2]
    assert room.seen_from(map_from_odom).distance_m(there) == pytest.approx(0.0)


def test_outside_and_where_nobody_has_looked_the_map_does_not_know():
    cells = np.zeros((30, 40))
    cells[10, 20], cells[:, 30:] = 100, -1
    room = RoomMap.of(grid_of(cells))
    asked = np.array([[-0.1, 1.0], [4.1, 1.0], [1.0, 3.1], [3.8, 1.0], [np.nan, 0.0]])
    assert np.isnan(room.distance_m(asked)).all()
    assert (room.furniture_log_odds(room.distance_m(asked)) == 0.0).all()


def test_a_map_without_anything_is_far_from_everything():
    room = RoomMap.of(grid_of(np.zeros((3, 3))))
    distance_m = room.distance_m(np.array([[0.1, 0.1]]))
    assert np.isinf(distance_m)
    assert room.furniture_log_odds(distance_m) < 0.0


@pytest.mark.parametrize("resolution_m", [0.025, 0.05, 0.1])
def test_things_on_an_occupied_cell_are_furniture_and_fade_out_beside_it(resolution_m):
    room = RoomMap.of(with_post(resolution_m=resolution_m))
    away_m = np.linspace(0.0, 1.0, 41)
    log_odds = room.furniture_log_odds(away_m)
    assert log_odds[0] > 2.5
    assert (np.diff(log_odds) <= 1e-12).all()
    reach_m = 1.5 * resolution_m + 0.1
    assert (log_odds[away_m > reach_m + 0.05] < 0.0).all()
    assert (log_odds[away_m < reach_m - 0.03] > 0.0).all()
    assert -0.5 < log_odds[-1] < 0.0


def test_half_occupied_counts_as_free():
    cells = np.full((3, 3), 50)
    assert np.isinf(RoomMap.of(grid_of(cells)).distance_m(np.array([[0.1, 0.1]])))


def test_a_map_is_drawn_where_it_is_asked():
    room = RoomMap.of(with_post(origin=(3.0, 1.0, 0.5)))
    assert room.located.origin == pytest.approx((3.0, 1.0, 0.5))
    map_from_odom = RigidTransform.from_planar(1.0, -2.0, np.pi / 2)
    x_m, y_m, yaw_rad = room.seen_from(map_from_odom).located.origin
    # Seen from odom at (1, -2) that looks along the map's y axis: (2, 3) away is 3 ahead, 2 right.
    assert (x_m, y_m, yaw_rad) == pytest.approx((3.0, -2.0, 0.5 - np.pi / 2))
