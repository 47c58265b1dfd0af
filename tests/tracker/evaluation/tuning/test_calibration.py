from dataclasses import fields, replace

import numpy as np
import pytest
from scipy.stats import chi2

from tracker.errors import CalibrationError
from tracker.evaluation.metrics.consistency import normalized_squared
from tracker.evaluation.tuning.calibration import ALIKE_S, calibrate, expected_bearings
from tracker.evaluation.tuning.sightings import Sightings
from tracker.geometry import RigidTransform

TRUE = np.array([0.06, -0.08, np.deg2rad(4.0)])
REACH_M, SCATTER_M = 0.3, 0.1


def stretch_of_hands(rng, number, *, side=None, range_m=(1.2, 6.0), bearing_rad=0.55, frames=10):
    """Somebody who stands somewhere with a hand up, and keeps it at one place beside the body."""
    bearing, distance = rng.uniform(-bearing_rad, bearing_rad), rng.uniform(*range_m)
    body = np.tile(distance * np.array([np.cos(bearing), np.sin(bearing)]), (frames, 1))
    side = rng.choice([-1.0, 1.0]) if side is None else side
    same = np.full(frames, rng.normal(0.0, SCATTER_M) / distance)
    base = Sightings(
        stamp_ns=round(number * ALIKE_S * 1e9) + np.arange(frames) * 100_000_000,
        hand=np.arange(frames),
        bearing_rad=np.zeros(frames),
        std_rad=np.full(frames, 0.2 / distance),
        side=np.full(frames, side),
        body_xy_m=body,
        size_misfit=np.zeros(frames),
    )
    return replace(base, bearing_rad=expected_bearings(base, TRUE, REACH_M) + same)


def recording(seed, stretches=40, **where):
    rng = np.random.default_rng(seed)
    return Sightings.concatenate(*(stretch_of_hands(rng, n, **where) for n in range(stretches)))


def test_the_expected_bearing_is_that_of_plane_trigonometry():
    """A body 2 m ahead of a camera that stands 0.5 m farther right and looks 10 degrees left."""
    sighting = replace(recording(1)[:1], body_xy_m=np.array([[2.0, 0.0]]), side=np.zeros(1))
    expected = expected_bearings(sighting, np.array([0.0, -0.5, np.deg2rad(10.0)]), REACH_M)
    assert np.rad2deg(expected) == pytest.approx([np.rad2deg(np.arctan(0.25)) - 10.0])


def test_somebody_left_of_their_hand_shows_it_to_the_right():
    sighting = replace(recording(1)[:1], body_xy_m=np.array([[2.0, 0.0]]), side=np.ones(1))
    expected = expected_bearings(sighting, np.zeros(3), 0.3)
    assert expected == pytest.approx([-np.arctan(0.15)])


def test_the_truth_lies_within_the_stated_uncertainty():
    """Over 60 recordings the normalized error squared is chi-square of three numbers."""
    nees = []
    for seed in range(60):
        found = calibrate(recording(seed))
        nees.append(normalized_squared(TRUE - found.correction, found.covariance))
    low, high = chi2.ppf([0.001, 0.999], 3 * len(nees)) / len(nees)
    assert low < np.mean(nees) < high


def test_the_reach_and_the_scatter_of_hands_are_found():
    found = calibrate(recording(3, 200))
    assert found.reach_m == pytest.approx(REACH_M, abs=4 * SCATTER_M / np.sqrt(200))
    assert found.scatter_m == pytest.approx(SCATTER_M, rel=0.25)


def test_hands_of_somebody_else_hardly_matter():
    """Every tenth hand has only a body beside it that is not its owner's."""
    good = recording(5, 100)
    off = (good.stamp_ns // round(ALIKE_S * 1e9)) % 10 == 0
    wrong = replace(good, bearing_rad=good.bearing_rad + np.where(off, 0.5, 0.0))
    found, disturbed = calibrate(good), calibrate(wrong)
    assert np.all(np.abs(disturbed.correction - TRUE) < 3 * disturbed.std)
    assert np.all(disturbed.std < 2 * found.std)


def test_of_several_bodies_beside_a_ray_the_one_that_fits_is_taken():
    good = recording(7, 60)
    beside = replace(
        good, body_xy_m=good.body_xy_m * 1.6 + [0.0, 0.9], size_misfit=good.size_misfit + 4.0
    )
    names = [item.name for item in fields(Sightings)]
    both = Sightings(*(np.concatenate([getattr(beside, n), getattr(good, n)]) for n in names))
    found = calibrate(both)
    assert np.mean(found.rows >= len(beside)) > 0.95
    assert np.all(np.abs(found.correction - TRUE) < 3 * found.std)


def test_torsos_whose_rays_meet_the_body_need_no_sides():
    found = calibrate(recording(9, 60, side=0.0))
    assert found.reach_m == 0.0
    assert np.all(np.abs(found.correction - TRUE) < 3 * found.std)


def test_a_correction_is_applied_in_the_cameras_own_frame():
    believed = RigidTransform.from_planar(1.0, 2.0, np.pi / 2)
    found = replace(calibrate(recording(2)), correction=np.array([0.1, 0.0, 0.2]))
    assert found.apply_to(believed).planar == pytest.approx([1.0, 2.1, np.pi / 2 + 0.2])


@pytest.mark.parametrize(
    ("where", "message"),
    [
        ({"range_m": (3.0, 3.01)}, "near and far"),
        ({"bearing_rad": 0.01}, "left and right of the picture"),
        ({"side": 1.0, "range_m": (3.0, 3.4)}, "determine the"),
    ],
    ids=["one distance", "one direction", "one hand at one distance"],
)
def test_data_that_do_not_determine_it_are_refused_with_what_to_record(where, message):
    with pytest.raises(CalibrationError, match=message):
        calibrate(recording(1, 12, **where))


@pytest.mark.parametrize("sightings", [Sightings.none(), recording(1, 3)], ids=["none", "few"])
def test_too_few_hands_are_refused(sightings):
    with pytest.raises(CalibrationError, match="Record for a minute"):
        calibrate(sightings)
