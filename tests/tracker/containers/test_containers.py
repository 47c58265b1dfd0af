"""Containers: what they check, what they protect, and how batches are cut and joined."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from tracker.containers import (
    CameraImage,
    Hands,
    Measurements,
    OccupancyGrid,
    Pose,
    Scan,
    SensorKind,
    Tracks,
    Truth,
)
from tracker.errors import ClockError, ShapeError


def hands(count):
    rng = np.random.default_rng(count)
    score, right, measure = rng.uniform(size=(3, count))
    landmarks = rng.uniform(0, 480, (count, 21, 2))
    return Hands(landmarks, score, right, np.arange(count) % 2 == 0, measure)


def tracks(count, **changes):
    fields = {
        "stamp_ns": 5,
        "id": np.arange(count) + 10,
        "mean": np.arange(4.0 * count).reshape(count, 4),
        "covariance": np.tile(np.eye(4), (count, 1, 1)),
        "existence": np.full(count, 0.9),
        "confirmed": np.ones(count, bool),
        "raised": np.zeros(count, bool),
        "raised_since_ns": np.full(count, -1),
        "age_s": np.ones(count),
        "unseen_s": np.zeros(count),
        "hand": np.full(count, -1),
    }
    return Tracks(**(fields | changes))


def scan(ranges_m, **changes):
    fields = {
        "stamp_ns": 0,
        "frame_id": "laser",
        "angle_min_rad": -1.0,
        "angle_increment_rad": 0.5,
        "range_min_m": 0.1,
        "range_max_m": 10.0,
        "ranges_m": ranges_m,
    }
    return Scan(**(fields | changes))


def test_an_image_knows_its_size():
    image = CameraImage(0, "camera", np.zeros((480, 640, 3), np.uint8))
    assert (image.height, image.width) == (480, 640)


@pytest.mark.parametrize(
    "pixels",
    [
        np.zeros((480, 640), np.uint8),
        np.zeros((480, 640, 4), np.uint8),
        np.zeros((0, 640, 3), np.uint8),
        np.zeros((480, 640, 3), np.float32),
    ],
    ids=["gray", "four channels", "no rows", "floats"],
)
def test_what_is_no_picture_is_refused_with_its_shape_and_type(pixels):
    with pytest.raises(ShapeError) as caught:
        CameraImage(0, "camera", pixels)
    assert str(pixels.shape) in str(caught.value)
    assert str(pixels.dtype) in str(caught.value)


@pytest.mark.parametrize("stamp", [-1, 1.5, "now", None])
def test_what_is_no_stamp_is_refused(stamp):
    with pytest.raises(ClockError, match="integer nanoseconds"):
        scan([1.0], stamp_ns=stamp)


def test_a_scan_says_which_beams_returned_and_where_they_look():
    turn = scan([math.nan, math.inf, -math.inf, 0.0, 0.05, 0.1, 5.0, 10.0, 10.1])
    assert turn.valid.tolist() == [False] * 5 + [True] * 3 + [False]
    np.testing.assert_allclose(turn.angles_rad[:4], [-1.0, -0.5, 0.0, 0.5])


def test_a_scan_of_a_clockwise_scanner_is_fine():
    assert scan([1.0, 2.0], angle_increment_rad=-0.1).angles_rad.tolist() == [-1.0, -1.1]


def test_a_scan_without_beams_is_fine():
    assert scan([], angle_increment_rad=0.0).valid.shape == (0,)


@pytest.mark.parametrize(
    "changes",
    [
        {"ranges_m": np.ones((2, 2))},
        {"angle_increment_rad": 0.0},
        {"angle_increment_rad": math.nan},
        {"angle_min_rad": math.inf},
    ],
)
def test_a_scan_whose_numbers_make_no_sense_is_refused(changes):
    with pytest.raises(ShapeError):
        scan(**({"ranges_m": [1.0, 2.0]} | changes))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"cells": np.zeros((0, 3), np.int8)}, "(0, 3)"),
        ({"cells": np.zeros(3, np.int8)}, "(3,)"),
        ({"cells": np.full((2, 2), 101, np.int8)}, "101"),
        ({"cells": np.full((2, 2), -2, np.int8)}, "-2"),
        ({"resolution_m": 0.0}, "resolution of 0.0"),
        ({"resolution_m": float("nan")}, "resolution of nan"),
        ({"origin": (0.0, float("inf"), 0.0)}, "inf"),
    ],
    ids=["no cells", "one row", "above 100", "below -1", "no size", "nan", "far away"],
)
def test_a_map_that_makes_no_sense_is_refused(changes, words):
    whole = {
        "stamp_ns": 0,
        "frame_id": "map",
        "resolution_m": 0.05,
        "origin": (0.0, 0.0, 0.0),
        "cells": np.zeros((2, 2), np.int8),
    }
    with pytest.raises(ShapeError) as caught:
        OccupancyGrid(**(whole | changes))
    assert words in str(caught.value)


def test_arrays_that_disagree_are_refused_with_every_shape():
    with pytest.raises(ShapeError) as caught:
        tracks(3, mean=np.zeros((2, 4)), hand=np.zeros(4))
    for words in ("Tracks", "mean (2, 4)", "hand (4,)", "id (3,)", "covariance (3, 4, 4)"):
        assert words in str(caught.value)


def test_hands_without_21_landmarks_are_refused():
    one = np.ones(1)
    with pytest.raises(ShapeError, match=r"landmarks_px \(1, 20, 2\)"):
        Hands(np.zeros((1, 20, 2)), one, one, one, one)


def test_hands_know_no_torso_unless_told():
    unknown = hands(2)
    assert not unknown.is_owned.any()
    assert np.isnan(unknown.seated).all()
    known = replace(unknown, torso_px=[(5, 6), (np.nan, 6)])
    assert known.is_owned.tolist() == [True, False]
    with pytest.raises(ShapeError, match=r"torso_px \(3, 2\)"):
        replace(unknown, torso_px=np.zeros((3, 2)))


def test_hands_are_joined_in_order():
    joined = Hands.concatenate(hands(2), Hands.none(), hands(3))
    assert len(joined) == 5
    np.testing.assert_array_equal(joined.score[2:], hands(3).score)


def test_truth_that_disagrees_is_refused():
    with pytest.raises(ShapeError, match=r"xy_m \(2, 3\)"):
        Truth(0, np.arange(2), np.zeros((2, 3)), np.zeros(2, bool), np.zeros(2, bool))


def test_a_pose_with_a_covariance_of_another_shape_is_refused():
    with pytest.raises(ShapeError, match=r"\(3, 3\)"):
        Pose(0, "map", (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), np.eye(3))


@pytest.mark.parametrize(
    ("batch", "name"),
    [
        (hands(2), "landmarks_px"),
        (tracks(2), "covariance"),
        (Measurements.cartesian([[1.0, 2.0]], np.eye(2)), "values"),
        (scan([1.0]), "ranges_m"),
        (Truth(0, np.arange(1), np.zeros((1, 2)), np.ones(1), np.ones(1)), "xy_m"),
        (Pose(0, "map", (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)), "covariance_m2"),
    ],
    ids=lambda item: item if isinstance(item, str) else type(item).__name__,
)
def test_arrays_are_read_only_and_fields_frozen(batch, name):
    with pytest.raises(ValueError, match="read-only"):
        getattr(batch, name)[0] = 1.0
    with pytest.raises(AttributeError):
        setattr(batch, name, None)


def test_the_callers_own_array_stays_writable():
    ranges = np.ones(3)
    scan(ranges)
    ranges[0] = 2.0


def test_lists_become_arrays_of_the_documented_types():
    batch = tracks(1, id=[7], raised=[1], age_s=[2])
    assert (batch.id.dtype, batch.raised.dtype) == (np.int64, np.bool_)
    assert batch.age_s.dtype == np.float64


@pytest.mark.parametrize(
    ("rows", "ids"),
    [
        (np.array([True, False, True]), [10, 12]),
        ([2, 0], [12, 10]),
        (slice(1, None), [11, 12]),
        ([], []),
        (-1, [12]),
        (np.int64(1), [11]),
    ],
    ids=["mask", "rows", "slice", "none", "last", "one"],
)
def test_selecting_rows_gives_a_batch_again(rows, ids):
    chosen = tracks(3, selected_id=11)[rows]
    assert chosen.id.tolist() == ids
    assert len(chosen) == len(chosen.mean) == len(ids)
    assert (chosen.stamp_ns, chosen.selected_id) == (5, 11)
    np.testing.assert_array_equal(chosen.mean[:, 0], 4.0 * (np.array(ids, float) - 10))


@pytest.mark.parametrize("rows", [np.zeros((2, 2), int), None], ids=["table", "none"])
def test_rows_that_are_no_list_are_refused(rows):
    with pytest.raises(ShapeError, match="a mask, a slice or a list"):
        tracks(3)[rows]


def test_the_row_of_a_person_is_found_by_identity():
    batch = tracks(3)
    assert batch.row_of(12) == 2
    assert batch.row_of(99) is None
    assert batch.row_of(None) is None


@pytest.mark.parametrize(
    "empty", [Hands.none(), Measurements.none(), Tracks.none(7)], ids=["hands", "claims", "tracks"]
)
def test_nothing_is_a_batch_of_length_zero(empty):
    assert len(empty) == 0
    assert len(empty[np.zeros(0, bool)]) == 0


def test_the_length_of_a_hand_goes_from_the_wrist_to_the_middle_fingers_tip():
    landmarks = np.zeros((1, 21, 2))
    landmarks[0, 0], landmarks[0, 12] = (100.0, 200.0), (103.0, 196.0)
    one = np.ones(1)
    hand = Hands(landmarks, one, one, one, one)
    assert hand.length_px.tolist() == [5.0]
    assert hand.wrist_px.tolist() == [[100.0, 200.0]]


def test_polar_claims_take_one_number_for_all_rows():
    claims = Measurements.polar([0.1, 0.2], 2.0, 0.01, [0.1, 0.3], (1.0, 2.0, 3.0))
    np.testing.assert_array_equal(claims.values, [[0.1, 2.0], [0.2, 2.0]])
    np.testing.assert_allclose(claims.covariance[1], [[1e-4, 0.0], [0.0, 0.09]])
    np.testing.assert_array_equal(claims.sensor_pose, [[1.0, 2.0, 3.0]] * 2)
    assert claims.kind.tolist() == [SensorKind.BEARING_RANGE] * 2
    assert claims.raised.all()
    assert claims.person.tolist() == claims.hand.tolist() == claims.identity.tolist() == [-1, -1]


def test_what_is_nan_decides_the_kind_row_by_row():
    claims = Measurements.polar(
        [0.1, 0.2, math.nan], [math.nan, 2.0, 3.0], [0.02, 0.02, math.nan], [math.nan, 0.1, 0.1]
    )
    assert claims.kind.tolist() == [SensorKind.BEARING, SensorKind.BEARING_RANGE, SensorKind.RANGE]
    np.testing.assert_array_equal(claims.values, [[0.1, math.nan], [0.2, 2.0], [math.nan, 3.0]])
    np.testing.assert_allclose(
        claims.covariance[:, [0, 1], [0, 1]], [[4e-4, 1.0], [4e-4, 0.01], [1.0, 0.01]]
    )
    assert not claims.covariance[:, [0, 1], [1, 0]].any()


def test_bearings_and_ranges_alone_are_polar_claims_without_the_other():
    doubt = np.diag([0.01, 0.01, 0.0])
    details = {"raised": False, "identity": [7, 8], "sensor_pose_covariance": doubt}
    bearings = Measurements.bearings([0.1, 0.2], 0.02, (1.0, 2.0, 3.0), **details)
    ranges = Measurements.ranges([3.0, 4.0], [0.1, 0.2], np.eye(3)[:2], **details)
    assert bearings.kind.tolist() == [SensorKind.BEARING] * 2
    assert ranges.kind.tolist() == [SensorKind.RANGE] * 2
    np.testing.assert_array_equal(bearings.values[:, 0], [0.1, 0.2])
    np.testing.assert_array_equal(ranges.values[:, 1], [3.0, 4.0])
    np.testing.assert_array_equal(ranges.sensor_pose, np.eye(3)[:2])
    for claims in (bearings, ranges):
        assert claims.identity.tolist() == [7, 8]
        assert not claims.raised.any()
        np.testing.assert_array_equal(claims.sensor_pose_covariance, [doubt] * 2)


def test_one_range_of_one_anchor_is_a_batch_of_one():
    assert Measurements.ranges(3.0, 0.1).values[:, 1].tolist() == [3.0]


def test_cartesian_claims_take_one_point_or_many():
    assert len(Measurements.cartesian([1.0, 2.0], np.eye(2))) == 1
    assert len(Measurements.cartesian([], np.eye(2))) == 0
    claims = Measurements.cartesian(np.ones((3, 2)), np.eye(2), raised=[True, False, True])
    assert claims.covariance.shape == (3, 2, 2)
    assert claims.raised.tolist() == [True, False, True]


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        (([0.1, 0.2], [1.0, 2.0, 3.0], 0.1, 0.1), "range_m"),
        (([0.1, 0.2], 1.0, [0.1] * 3, 0.1), "bearing_std_rad"),
        (([0.1, 0.2], 1.0, 0.1, 0.1, (0.0, 0.0)), "sensor_pose"),
    ],
)
def test_a_column_of_another_length_is_refused_by_name(arguments, name):
    with pytest.raises(ShapeError, match=rf"`{name}` has shape .* expected \(2,"):
        Measurements.polar(*arguments)


def test_joined_batches_keep_the_order_of_their_rows():
    polar = Measurements.polar([0.1, 0.2], 2.0, 0.01, 0.1, person=[4, 5], identity=9)
    joined = Measurements.concatenate(
        polar, Measurements.none(), Measurements.cartesian([1.0, 2.0], np.eye(2))
    )
    assert joined.values[:, 0].tolist() == [0.1, 0.2, 1.0]
    assert joined.kind.tolist() == [0, 0, 1]
    assert joined.person.tolist() == [4, 5, -1]
    assert joined.identity.tolist() == [9, 9, -1]
    with pytest.raises(ValueError, match="read-only"):
        joined.values[0] = 0.0


ORDINARY_OR_NOT = st.one_of(
    st.floats(1e-3, 5.0),
    st.floats(allow_nan=True, allow_infinity=True),
    st.sampled_from([0.0, -0.0, 1e-6, 1e-5, 6.0, 2 * np.pi, 1e9**0.5, 1e9]),
)


@settings(max_examples=300, deadline=None)
@given(
    columns=hnp.arrays(float, (4, 3), elements=ORDINARY_OR_NOT),
    pose=hnp.arrays(float, (3, 3), elements=ORDINARY_OR_NOT),
)
def test_bearings_and_ranges_that_are_taken_pass_every_check_of_the_class(columns, pose):
    taken = Measurements.polar(*columns, pose, refuse="drop")
    assert len(replace(taken)) == len(taken)


@pytest.mark.parametrize(
    ("range_m", "bearing_std_rad", "range_std_m"),
    [(0.0, 0.02, 0.1), (2.0, 6.2, 0.1), (2.0, 0.02, 100.0), (2.0, 2e-6, 2e-6), (9e8, 0.02, 3e4)],
    ids=["touching", "nearly no bearing", "nearly no range", "laser tracker", "out of sight"],
)
def test_unusual_bearings_and_ranges_are_taken_as_they_are(range_m, bearing_std_rad, range_std_m):
    claim = Measurements.polar(0.1, range_m, bearing_std_rad, range_std_m)
    assert claim.values.tolist() == [[0.1, range_m]]
    assert claim.covariance[0].tolist() == np.diag([bearing_std_rad**2, range_std_m**2]).tolist()


def test_without_a_range_its_noise_is_one_and_the_kind_says_so():
    for range_m in (math.nan, [math.nan, math.nan]):
        claims = Measurements.polar([0.1, -0.2], range_m, 0.02, [-1.0, math.nan])
        assert claims.kind.tolist() == [SensorKind.BEARING] * 2
        assert claims.covariance.tolist() == [np.diag([0.02**2, 1.0]).tolist()] * 2
        assert np.isnan(claims.values[:, 1]).all()
