from dataclasses import replace

import numpy as np
import pytest

from tracker import Scan
from tracker.notes import NoteKind
from tracker.ranging import mend_scan
from tracker.ranging.scan.odd_scans import BEAMS_MAX

RNG = np.random.default_rng(8)


def room(beams=541, near_m=0.4, far_m=7.0, range_max_m=25.0, range_min_m=0.06):
    ranges = RNG.uniform(near_m, far_m, beams)
    return Scan(9, "laser", np.radians(-135), np.radians(270 / (beams - 1)), range_min_m,
                range_max_m, ranges, 1e-5)  # fmt: skip


def in_millimeters(scan):
    return replace(
        scan,
        ranges_m=scan.ranges_m * 1000,
        range_min_m=scan.range_min_m * 1000,
        range_max_m=scan.range_max_m * 1000,
    )


def in_degrees(scan):
    return replace(
        scan,
        angle_min_rad=float(np.degrees(scan.angle_min_rad)),
        angle_increment_rad=float(np.degrees(scan.angle_increment_rad)),
    )


def assert_same(scan, other):
    np.testing.assert_allclose(scan.ranges_m, other.ranges_m)
    np.testing.assert_allclose(scan.angles_rad, other.angles_rad)
    assert scan.range_min_m == pytest.approx(other.range_min_m)
    assert scan.range_max_m == pytest.approx(other.range_max_m)


@pytest.mark.parametrize("far_m", [1.5, 4.0, 25.0], ids=str)
@pytest.mark.parametrize("beams", [60, 541, 3600], ids=str)
def test_ranges_in_millimeters_are_converted_and_said(far_m, beams):
    scan = room(beams, far_m=far_m)
    mended, (note,) = mend_scan(in_millimeters(scan))
    assert_same(mended, scan)
    assert note.kind is NoteKind.SCAN_IN_MILLIMETERS
    assert note.kind.is_remark
    assert "25000" in note.text


@pytest.mark.parametrize("beams", [31, 541, 2000], ids=str)
def test_angles_in_degrees_are_converted_and_said(beams):
    scan = room(beams)
    mended, (note,) = mend_scan(in_degrees(scan))
    assert_same(mended, scan)
    assert note.kind is NoteKind.SCAN_IN_DEGREES


def test_a_clockwise_scanner_of_degrees_and_millimeters_is_converted_twice():
    scan = replace(room(), angle_min_rad=np.radians(135), angle_increment_rad=-np.radians(0.5))
    mended, notes = mend_scan(in_millimeters(in_degrees(scan)))
    assert_same(mended, scan)
    assert {note.kind for note in notes} == {
        NoteKind.SCAN_IN_DEGREES,
        NoteKind.SCAN_IN_MILLIMETERS,
    }


def test_millimeters_with_limits_in_meters_leave_the_limits():
    scan = room()
    mended, _ = mend_scan(replace(scan, ranges_m=scan.ranges_m * 1000))
    assert_same(mended, scan)


@pytest.mark.parametrize("no_return", [0.0, 65_535.0, np.inf, np.nan, 25_000.0], ids=str)
def test_millimeters_are_recognized_whatever_stands_for_no_return(no_return):
    scan = in_millimeters(room())
    ranges = scan.ranges_m.copy()
    ranges[RNG.random(len(ranges)) < 0.7] = no_return
    mended, (note,) = mend_scan(replace(scan, ranges_m=ranges))
    assert note.kind is NoteKind.SCAN_IN_MILLIMETERS
    assert mended.valid.sum() == pytest.approx(0.3 * len(ranges), rel=0.3) or no_return == 25_000.0


HONEST = {
    "a car's scanner on the open road": room(near_m=5.0, far_m=280.0, range_max_m=300.0),
    "no limit told": room(range_max_m=1e9),
    "an open hall whose no returns are 655.35": replace(
        room(), ranges_m=np.where(np.arange(541) < 530, 655.35, RNG.uniform(2, 9, 541))
    ),
    "nothing but no returns of 655.35": replace(room(), ranges_m=np.full(541, 655.35)),
    "nothing but infinity": replace(room(), ranges_m=np.full(541, np.inf)),
    "a limit in millimeters, ranges in meters": room(range_max_m=12_000.0),
    "two turns": replace(room(400), angle_increment_rad=np.radians(1.8)),
    "a few coarse beams": Scan(0, "", -1.0, 0.5, 0.1, 9.0, np.full(5, 3.0)),
    "one beam": Scan(0, "", 0.0, 45.0, 0.1, 9.0, [3.0]),
    "no beams": Scan(0, "", 0.0, 0.0, 0.1, 9.0, []),
}


@pytest.mark.parametrize("scan", HONEST.values(), ids=HONEST)
def test_an_honest_scan_is_left_as_it_came(scan):
    mended, notes = mend_scan(scan)
    assert mended is scan
    assert notes == ()


def test_a_million_beams_are_thinned_out_and_said():
    beams = 1_000_000
    step = 2 * np.pi / beams
    scan = Scan(0, "laser", 0.0, step, 0.1, 9.0, RNG.uniform(0.2, 8.0, beams), 1e-7)
    mended, (note,) = mend_scan(scan)
    assert note.kind is NoteKind.SCAN_THINNED
    assert len(mended.ranges_m) <= BEAMS_MAX
    every = round(mended.angle_increment_rad / step)
    np.testing.assert_array_equal(mended.ranges_m, scan.ranges_m[::every])
    np.testing.assert_allclose(mended.angles_rad, scan.angles_rad[::every])
    assert mended.end_ns == pytest.approx(scan.end_ns, abs=every * 100)
