import numpy as np
import pytest

from tracker import Scan
from tracker.geometry import RigidTransform
from tracker.ranging import beam_index, locate_scan, median_range


def make_scan(ranges, angle_min, increment, range_min=0.1, range_max=10.0):
    ranges_m = np.asarray(ranges, float)
    scan = Scan(0, "laser", angle_min, increment, range_min, range_max, ranges_m)
    return locate_scan(scan, RigidTransform())


@pytest.fixture
def half_degree_scan():
    """-90..90 degrees in steps of half a degree, beam i returns 1 m + i mm."""
    return make_scan(1.0 + 0.001 * np.arange(361), np.radians(-90), np.radians(0.5))


@pytest.fixture
def full_turn_scan():
    """0..2 pi in steps of one degree, beam i returns 1 m + i mm."""
    return make_scan(1.0 + 0.001 * np.arange(360), 0.0, np.radians(1.0))


@pytest.mark.parametrize(
    ("angle_deg", "index"),
    [(-90.0, 0), (0.0, 180), (0.3, 180), (-0.2, 179), (10.0, 200), (89.9, 359)],
)
def test_equation_11_rounds_the_quotient_down(half_degree_scan, angle_deg, index):
    assert beam_index(half_degree_scan, np.radians([angle_deg])).tolist() == [index]


@pytest.mark.parametrize(("angle_deg", "index"), [(-20.0, 340), (340.0, 340), (-0.5, 359), (5, 5)])
def test_equation_11_answers_negative_angles_of_a_scanner_of_a_full_turn(
    full_turn_scan, angle_deg, index
):
    assert beam_index(full_turn_scan, np.radians([angle_deg])).tolist() == [index]


def test_equation_11_works_for_a_scanner_that_turns_clockwise():
    scan = make_scan(np.ones(181), np.radians(90), np.radians(-1.0))
    assert beam_index(scan, np.radians([90.0, 0.0, -89.5])).tolist() == [0, 90, 179]


def test_algorithm_5_takes_the_median_of_seven_beams(half_degree_scan):
    # Beams 197..203 return 1.197..1.203 m.
    assert median_range(half_degree_scan, np.radians([10.0]))[0] == pytest.approx(1.2)


def test_algorithm_5_counts_only_ranges_within_the_scanners_limits():
    ranges = np.full(181, 2.0)
    ranges[87:94] = [0.05, np.inf, np.nan, 3.0, 99.0, 4.0, -1.0]  # two of seven are valid
    scan = make_scan(ranges, np.radians(-90), np.radians(1.0))
    assert median_range(scan, [0.0])[0] == pytest.approx(3.5)


def test_algorithm_5_gives_nothing_where_no_beam_of_the_window_returns():
    scan = make_scan(np.full(181, np.inf), np.radians(-90), np.radians(1.0))
    assert np.isnan(median_range(scan, [0.0])[0])


def test_the_window_wraps_around_the_seam_of_a_full_turn(full_turn_scan):
    # Around beam 359: 356, 357, 358, 359, 0, 1, 2 return 1.356, 1.357, 1.358, 1.359, 1, 1.001 ...
    assert median_range(full_turn_scan, np.radians([-0.5]))[0] == pytest.approx(1.356)


def test_the_window_ends_with_a_scan_that_is_no_full_turn(half_degree_scan):
    # Around beam 0 only 0..3 are there: the median of 1.000 .. 1.003.
    assert median_range(half_degree_scan, np.radians([-90.0]))[0] == pytest.approx(1.0015)


def test_an_angle_beside_the_scan_has_no_range(half_degree_scan):
    assert np.isnan(median_range(half_degree_scan, [np.pi, np.nan])).all()


def test_a_scan_without_beams_has_no_range():
    scan = make_scan([], 0.0, 0.0)
    assert np.isnan(median_range(scan, [0.0, 1.0])).all()


def test_the_window_is_a_parameter():
    ranges = np.full(181, 5.0)
    ranges[90] = 1.0
    scan = make_scan(ranges, np.radians(-90), np.radians(1.0))
    assert median_range(scan, [0.0], window_beams=0)[0] == 1.0
    assert median_range(scan, [0.0], window_beams=1)[0] == 5.0
