import numpy as np
import pytest

from tracker.containers import Scan
from tracker.geometry import RigidTransform
from tracker.ranging import locate_scan
from tracker.report.history.hit_grid import HitGrid


def scan(*ranges_m, increment_rad=np.pi / 2, x_m=0.0):
    beams = Scan(0, "laser", 0.0, increment_rad, 0.1, 100.0, np.array(ranges_m))
    return locate_scan(beams, RigidTransform.from_planar(x_m, 0.0, 0.0))


def test_a_cell_counts_scans_not_beams():
    grid = HitGrid(cell_m=0.1)
    for _ in range(3):
        grid.add(scan(2.02, 2.02, 2.02, increment_rad=1e-3))
    points, counts = grid.hits
    assert counts.tolist() == [3.0]
    assert points == pytest.approx(np.array([[2.05, 0.05]]))


def test_a_robot_that_drives_far_keeps_the_memory_and_coarsens_the_cells():
    grid = HitGrid()
    for x in (0.0, 1000.0, -700.0):
        grid.add(scan(1.0, x_m=x))
    points, counts = grid.hits
    assert grid.cell_m > 1.0
    assert counts.tolist() == [1.0, 1.0, 1.0]
    assert points[:, 0] == pytest.approx([-699.0, 1.0, 1001.0], abs=grid.cell_m)


def test_far_returns_and_empty_scans_leave_no_trace():
    grid = HitGrid()
    grid.add(scan(50.0))
    grid.add(scan())
    points, counts = grid.hits
    assert points.shape == (0, 2)
    assert counts.shape == (0,)
