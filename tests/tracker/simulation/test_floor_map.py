import numpy as np
import pytest

from tracker.ranging import RoomMap
from tracker.simulation import load_scene, scene_from_mapping
from tracker.simulation.floor_map import floor_map
from tracker.simulation.legs import chair_legs, table_posts

ROOM = [[-2.0, -2.0], [3.0, -2.0], [3.0, 2.0], [-2.0, 2.0]]


def scene_with(**parts):
    walls = [{"corners_m": ROOM, "closed": True}]
    return scene_from_mapping({"duration_s": 1.0, "walls": walls} | parts)


def cells_at(scene, *points):
    grid = floor_map(scene)
    at = (np.array(points) - grid.origin[:2]) / grid.resolution_m
    return [int(grid.cells[int(row), int(column)]) for column, row in at]


def test_walls_and_posts_are_taken_the_room_is_free_and_beyond_it_nobody_knows():
    scene = scene_with(tables=[{"x_m": 1.0, "y_m": 0.5, "posts": 1}])
    assert cells_at(scene, (1.0, 0.5), (3.0, 1.0), (0.0, 0.0), (3.5, 0.0)) == [100, 100, 0, -1]


def test_a_room_that_the_robot_cannot_reach_is_unknown():
    wall = {"corners_m": [[1.0, -2.0], [1.0, 2.0]]}
    scene = scene_with(walls=[{"corners_m": ROOM, "closed": True}, wall])
    assert cells_at(scene, (0.0, 1.0), (2.0, 1.0)) == [0, -1]


def test_what_the_laser_looks_over_and_what_is_moved_all_day_is_on_no_map():
    low = {"corners_m": [[1.0, -1.0], [1.0, 1.0]], "height_m": 0.2}
    scene = scene_with(
        walls=[{"corners_m": ROOM, "closed": True}, low],
        chairs=[{"x_m": 0.5, "y_m": 0.5}, {"kind": "bar_stool", "x_m": -0.5, "y_m": 0.5}],
    )
    legs = [leg[:2] for chair in scene.chairs for leg in chair_legs(chair)]
    assert cells_at(scene, (1.0, 0.0), *legs) == [0] * 6


@pytest.mark.parametrize("name", ["bistro", "restaurant", "dining_hall"])
def test_every_post_of_the_scenes_is_found_on_its_map(name):
    scene = load_scene(name)
    posts = np.array([post[:2] for table in scene.tables for post in table_posts(table)])
    room = RoomMap.of(floor_map(scene))
    assert (room.distance_m(posts) <= 0.08).all()
    assert (room.furniture_log_odds(room.distance_m(posts)) > 2.0).all()


def test_a_scene_without_anything_has_a_map_all_the_same():
    grid = floor_map(scene_from_mapping({"duration_s": 1.0}))
    assert (grid.cells == 0).all()


def test_a_huge_room_is_mapped_in_larger_cells():
    corners = [[-5000.0, -5000.0], [5000.0, -5000.0], [5000.0, 5000.0], [-5000.0, 5000.0]]
    grid = floor_map(scene_with(walls=[{"corners_m": corners, "closed": True}]))
    assert grid.cells.size < 5_000_000
