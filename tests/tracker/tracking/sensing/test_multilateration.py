"""Ranges of three sensors that meet are a position."""

from dataclasses import replace

import numpy as np
import pytest

from tracker import Measurements, PersonTracker
from tracker.containers import SensorKind
from tracker.tracking.sensing.multilateration import with_positions

ANCHORS_M = np.array([[0.0, 0.0], [6.0, 0.0], [3.0, 5.0]])


def ranges_to(place_m, anchors_m=ANCHORS_M, off_m=0.0, std_m=0.1, **claimed):
    range_m = np.hypot(*(np.asarray(place_m) - anchors_m).T) + off_m
    poses = np.pad(anchors_m, ((0, 0), (0, 1)), constant_values=1.0)
    return Measurements.ranges(range_m, std_m, poses, **claimed)


@pytest.mark.parametrize("place_m", [(3.0, 1.5), (9.0, 9.0), (-4.0, 2.0), (0.05, 0.0)])
def test_three_ranges_that_meet_are_one_position(place_m):
    (met,) = [with_positions(ranges_to(place_m, raised=False, identity=7))]
    assert met.kind.tolist() == [SensorKind.POSITION]
    assert met.values[0] == pytest.approx(place_m, abs=1e-4)
    assert met.raised.tolist() == [False]
    assert met.identity.tolist() == [7]


def test_the_covariance_is_that_of_repeated_trials():
    rng, place_m, found = np.random.default_rng(4), np.array([2.5, 1.0]), []
    for _ in range(300):
        found.append(
            with_positions(ranges_to(place_m, off_m=0.05 * rng.normal(size=3), std_m=0.05))
        )
    values = np.array([each.values[0] for each in found if len(each) == 1])
    assert len(values) > 290
    np.testing.assert_allclose(np.cov(values.T), found[0].covariance[0], atol=6e-4)


@pytest.mark.parametrize(
    "measured",
    [
        ranges_to((3.0, 1.5))[:2],
        ranges_to((3.0, 1.5), np.array([[0.0, 0.0], [3.0, 0.0], [6.0, 0.1]])),
        ranges_to((3.0, 1.5), off_m=np.array([0.0, 0.0, -2.0])),
        replace(ranges_to((3.0, 1.5)), identity=np.array([1, 1, 2])),
        replace(ranges_to((3.0, 1.5)), raised=np.array([True, True, False])),
    ],
    ids=["two", "in line", "of several people", "of two tags", "raised and not"],
)
def test_ranges_that_do_not_meet_are_left_as_they_are(measured):
    left = with_positions(measured)
    assert left.kind.tolist() == measured.kind.tolist()
    np.testing.assert_array_equal(left.values, measured.values)


def test_everything_else_stays_in_its_order():
    camera = Measurements.polar([0.1, 0.2], [2.0, np.nan], 0.05, 0.1, (1.0, 2.0, 3.0))
    point = Measurements.cartesian([1.0, 2.0], np.eye(2))
    measured = Measurements.concatenate(camera, ranges_to((3.0, 1.5)), point)
    kinds = [SensorKind.BEARING_RANGE, SensorKind.BEARING, *[SensorKind.POSITION] * 2]
    met = with_positions(measured)
    assert met.kind.tolist() == kinds
    np.testing.assert_array_equal(met.sensor_pose[:2], camera.sensor_pose)
    np.testing.assert_array_equal(met.values[3], point.values[0])


def test_doubt_about_where_the_sensors_stand_widens_the_position():
    sure = ranges_to((3.0, 1.5))
    doubt = np.tile(np.diag([0.04, 0.04, 0.0]), (3, 1, 1))
    unsure = with_positions(replace(sure, sensor_pose_covariance=doubt))
    (known,) = with_positions(sure).covariance
    np.testing.assert_allclose(unsure.covariance[0], known * (0.05 / 0.01), rtol=1e-4)


def test_a_newcomer_whom_three_anchors_show_is_there():
    tracker = PersonTracker(compiled=False)
    for number in range(3):
        tracks = tracker.step(number * 10**8, ranges_to((3.0, 1.5)))
    assert tracks.id.tolist() == [1]
    assert tracks.raised.tolist() == [True]
    assert tracks.mean[0, :2] == pytest.approx([3.0, 1.5], abs=1e-3)
    assert tracks.refused == 0
