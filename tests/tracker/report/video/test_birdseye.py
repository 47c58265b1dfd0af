from dataclasses import replace

import numpy as np
import pytest

from tracker.containers import Measurements, Scan
from tracker.geometry import RigidTransform
from tracker.ranging import locate_scan
from tracker.report.palette import LIT, as_bgr, person_color
from tracker.report.video.birdseye import draw_birdseye


def where(picture, color):
    rows, columns = np.nonzero(np.all(picture == as_bgr(color), axis=-1))
    return np.array([columns.mean(), rows.mean()]) if len(rows) else None


@pytest.mark.parametrize("yaw_rad", [0.0, 1.0, -2.5], ids=["east", "left", "back"])
def test_a_person_ahead_on_the_left_is_above_the_camera_on_the_left(result_of, yaw_rad):
    pose = np.array([5.0, -3.0, yaw_rad])
    ahead = np.array([np.cos(yaw_rad), np.sin(yaw_rad)])
    left = np.array([-ahead[1], ahead[0]])
    x, y = pose[:2] + 2.0 * ahead + 1.0 * left
    picture = draw_birdseye(result_of(0, (1, x, y, True), sensor_pose=pose), ahead_m=4.0)
    scale = 480 * 0.84 / 4.0
    expected = [240 - 1.0 * scale, 480 * 0.84 - 2.0 * scale]
    assert where(picture, person_color(1)) == pytest.approx(expected, abs=2.0)


def test_only_the_selected_customer_is_lit(result_of):
    people = ((1, 1.0, 0.5, True), (2, 2.0, -0.5, True))
    lit = where(draw_birdseye(result_of(0, *people, selected=2)), LIT)
    assert lit is not None
    assert lit[0] > 240  # person 2 is on the right
    assert where(draw_birdseye(result_of(0, *people)), LIT) is None


def test_somebody_of_unknown_distance_is_a_fan_and_no_place(result_of):
    result = result_of(0, (1, 0.0, 3.0, True), sensor_pose=np.array([0.0, 0.0, np.pi / 2]))
    spread = np.diag([0.01, 4.0, 0.1, 0.1])[None]  # known across the ray alone
    unplaced = replace(result, tracks=replace(result.tracks, covariance=spread))
    picture, empty = draw_birdseye(unplaced), draw_birdseye(result_of(0))
    changed = np.any(picture != empty, axis=-1)
    ahead, aside = changed[120:396, 230:250], changed[120:396, 360:]
    assert ahead.any(axis=1).all(), "from the camera to the rim"
    assert not aside.any()
    at_place = round(480 * 0.84 * (1 - 3.0 / 4.0)), 240
    assert tuple(picture[at_place]) != as_bgr(person_color(1)), "no disc where nobody may stand"


def test_nothing_far_away_or_unknown_breaks_the_picture(result_of):
    nan_range = Measurements.polar([0.1], np.nan, 0.02, 0.1)
    beams = Scan(0, "", 0.0, 0.1, 0.1, 1e9, np.array([np.nan, np.inf, 1e8, 0.0]))
    scan = locate_scan(beams, RigidTransform())
    result = result_of(
        0, (1, 1e12, -1e12, True), (2, np.nan, 0.0, False),
        measurements=nan_range, scan=scan, sensor_pose=np.zeros(3),
    )  # fmt: skip
    assert draw_birdseye(result).shape == (480, 480, 3)


def test_pictures_do_not_draw_into_each_other(result_of):
    empty = draw_birdseye(result_of(0)).copy()
    draw_birdseye(result_of(0, (1, 1.0, 0.0, True), selected=1))
    assert np.array_equal(draw_birdseye(result_of(0)), empty)
