import numpy as np
import pytest

from tracker.ranging.scan.segments import find_segments


def nearest(found, range_m):
    """Row of the segment that is so far away."""
    return int(np.abs(found.range_m - range_m).argmin())


def test_a_round_thing_is_less_flat_than_the_wall(cast):
    found = find_segments(cast([(2.0, 0.5, 0.1)], beams=3600), 0.15)
    post, wall = nearest(found, np.hypot(2.0, 0.5) - 0.1), nearest(found, 6.0)
    # Seen evenly over its width, a half circle of radius 1 has the variances 1/3 along and
    # 2/3 - (pi / 4)^2 across.
    assert found.flatness[post] == pytest.approx(
        np.sqrt((2 / 3 - (np.pi / 4) ** 2) / (1 / 3)), rel=0.1
    )
    assert found.width_m[post] == pytest.approx(0.2, abs=0.02)
    assert found.beams.sum() == 3600
    assert found.range_m[wall] == pytest.approx(6.0)


def test_what_stands_in_front_of_all_beside_it_stands_free(cast):
    found = find_segments(cast([(2.0, -0.5, 0.1), (1.6, 1.0, 0.1), (2.0, 1.0, 0.1)]), 0.15)
    alone, beside = nearest(found, 1.962), nearest(found, np.hypot(2.0, 1.0) - 0.1)
    assert found.stands_free[alone]
    assert not found.stands_free[beside]


def test_the_wall_between_two_legs_is_in_a_gap(cast):
    found = find_segments(cast([(2.0, 0.15, 0.1), (2.0, -0.15, 0.1)], wall_m=4.0), 0.15)
    between = found.is_in_gap & (found.width_m < 1.0)
    assert between.sum() == 1
    assert found.range_m[between] == pytest.approx([4.0])


def test_segments_go_once_around_without_a_seam(cast):
    found = find_segments(cast([(2.0, 0.0, 0.1), (-2.0, 0.0, 0.1)]), 0.15)
    assert len(found.begins) == 4
    assert found.begins[0] == 0
    assert sorted(found.rows.tolist()) == list(range(720))
    assert 0 in found.rows[1:]  # the beam that looks along x is inside the first or last segment
