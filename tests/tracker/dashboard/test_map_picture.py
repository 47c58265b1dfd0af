import cv2
import numpy as np
import pytest

from tracker.containers import LocatedMap, OccupancyGrid
from tracker.dashboard.map_picture import MapPicture


def grid_of(cells, resolution_m=0.05):
    return OccupancyGrid(0, "map", resolution_m, (0.0, 0.0, 0.0), np.array(cells, np.int8))


def alpha_of(picture):
    return cv2.imdecode(np.frombuffer(picture.png(), np.uint8), cv2.IMREAD_UNCHANGED)[..., 3]


def test_occupied_cells_show_and_free_or_unknown_ones_do_not():
    alpha = alpha_of(MapPicture(1, grid_of([[0, 100, -1], [64, 65, 0]])))
    np.testing.assert_array_equal(alpha, [[0, 255, 0], [0, 255, 0]])


def test_a_large_map_is_shown_with_larger_cells_and_loses_none():
    cells = np.zeros((3001, 5), np.int8)
    cells[[0, 3000], [0, 4]] = 100
    picture = MapPicture(1, grid_of(cells))
    alpha = alpha_of(picture)
    assert alpha.shape == (1501, 3)
    assert np.argwhere(alpha).tolist() == [[0, 0], [1500, 2]]
    place = picture.place(LocatedMap(picture.grid, (1.0, 2.0, 0.5)))
    assert place == {"number": 1, "origin": [1.0, 2.0, 0.5], "pixel_m": pytest.approx(0.1)}


def test_only_another_map_has_another_number():
    picture = MapPicture(1, grid_of([[0]]))
    moved = LocatedMap(picture.grid, (1.0, 0.0, 0.0))
    assert picture.after(moved) is picture
    assert picture.after(LocatedMap(grid_of([[0]]), (0.0, 0.0, 0.0))).number == 2
