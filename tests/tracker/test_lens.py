"""Lenses against OpenCV's projections, and where their polynomials end."""

import cv2
import numpy as np
import pytest

from tracker.errors import ConfigError
from tracker.lens import LensKind, lens_of


def directions_at(off_axis_deg, turns=8):
    """Unit vectors (x right, y down, z ahead) so far off the axis, all around it."""
    off_axis, around = np.meshgrid(
        np.deg2rad(off_axis_deg), np.linspace(0.0, 2 * np.pi, turns, endpoint=False)
    )
    aside = np.sin(off_axis)
    return np.stack(
        [aside * np.cos(around), aside * np.sin(around), np.cos(off_axis)], -1
    ).reshape(-1, 3)


POLYNOMIALS = {
    "4": (-0.21, 0.06, 0.0004, -0.0007),
    "5": (-0.31, 0.12, 0.0011, -0.0002, -0.02),
    "8": (0.21, 0.04, -0.0003, 0.0006, 0.01, 0.42, 0.11, 0.02),
    "12": (0.2, 0.05, 0.0, 0.0004, 0.0, 0.3, 0.1, 0.01, 0.002, -0.001, 0.001, 0.0005),
    "14": (0.2, 0.05, 0.0, 0.0004, 0.0, 0.3, 0.1, 0.01, 0.0, 0.0, 0.0, 0.0, 0.03, -0.02),
}


@pytest.mark.parametrize("coefficients", POLYNOMIALS.values(), ids=POLYNOMIALS.keys())
@pytest.mark.parametrize("name", ["plumb_bob", "rational_polynomial", "thin_prism"])
def test_opencvs_polynomials_are_undone_whatever_the_driver_calls_them(name, coefficients):
    ahead = directions_at([0.0, 5.0, 20.0, 35.0])
    nowhere = np.zeros(3)
    shown, _ = cv2.projectPoints(ahead, nowhere, nowhere, np.eye(3), np.array(coefficients))
    found = lens_of(name, coefficients).directions(shown.reshape(-1, 2))
    np.testing.assert_allclose(found, ahead, atol=1e-7)


def test_a_fisheye_agrees_with_opencv_where_that_sees():
    coefficients = (-0.03, 0.004, -0.002, 0.0003)
    ahead = directions_at([1.0, 30.0, 60.0, 80.0])
    nowhere = np.zeros((1, 1, 3))
    shown, _ = cv2.fisheye.projectPoints(
        ahead[:, None], nowhere, nowhere, np.eye(3), np.array(coefficients)
    )
    lens = lens_of("fisheye", coefficients)
    np.testing.assert_allclose(lens.directions(shown.reshape(-1, 2)), ahead, atol=1e-7)
    np.testing.assert_allclose(lens.points(ahead), shown.reshape(-1, 2), atol=1e-9)


def test_a_fisheye_without_bending_shows_the_angle_itself_even_behind_the_camera():
    lens = lens_of("equidistant", (0.0,) * 4)
    angles = np.array([0.0, 0.5, 1.5, 2.0, 3.0])
    points = np.stack([angles, np.zeros(5)], -1)
    found = lens.directions(points)
    np.testing.assert_allclose(np.arctan2(found[:, 0], found[:, 2]), angles, atol=1e-9)
    np.testing.assert_allclose(lens.points(found), points, atol=1e-9)


@pytest.mark.parametrize(
    ("name", "coefficients"),
    [
        ("plumb_bob", (-0.5, 0.1, 0.0, 0.0, 0.0)),
        ("plumb_bob", (0.1, -0.4, 0.002, 0.001, 0.0)),
        ("equidistant", (-0.09, -0.03, 0.0, 0.0)),
    ],
    ids=["barrel", "mustache", "fisheye"],
)
def test_where_the_polynomial_turns_back_nothing_is_seen(name, coefficients):
    lens = lens_of(name, coefficients)
    end_rad = lens.max_off_axis_rad
    assert 0.3 < end_rad < 1.5
    inside, outside = directions_at(np.rad2deg([0.97 * end_rad, 1.05 * end_rad]), 1)
    np.testing.assert_allclose(lens.directions(lens.points(inside[None])), inside[None], atol=1e-6)
    assert np.isnan(lens.points(outside[None])).all()
    beyond = 1.3 * np.linalg.norm(lens.points(inside[None]))
    assert np.isnan(lens.directions(np.array([[beyond, 0.0], [0.0, -beyond]]))).all()


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("Plumb_Bob", LensKind.POLYNOMIAL),
        ("plumb bob", LensKind.POLYNOMIAL),
        ("Brown Conrady", LensKind.POLYNOMIAL),
        ("RADTAN", LensKind.POLYNOMIAL),
        ("Kannala Brandt4", LensKind.FISHEYE),
        ("kannala-brandt", LensKind.FISHEYE),
        (" Fisheye ", LensKind.FISHEYE),
    ],
)
def test_names_are_known_in_any_spelling(name, kind):
    assert lens_of(name, (0.01, 0.0, 0.0, 0.002)).kind is kind


@pytest.mark.parametrize("name", ["", "none", "Inverse Brown Conrady", "Modified Brown Conrady"])
def test_names_of_other_lenses_serve_only_with_zeros(name):
    assert lens_of(name, (0.0,) * 5).kind is LensKind.STRAIGHT
    with pytest.raises(ConfigError, match="defined for 0"):
        lens_of(name, (0.0, 0.1, 0.0, 0.0, 0.0))


@pytest.mark.parametrize(("name", "sent"), [("plumb_bob", 6), ("equidistant", 5), ("fisheye", 8)])
def test_coefficients_beyond_the_model_must_be_zeros(name, sent):
    some = (0.01, 0.002, 0.0, 0.001)
    padded = some + (0.0,) * (sent - 4)
    points = np.array([[0.3, -0.2]])
    np.testing.assert_array_equal(
        lens_of(name, padded).directions(points), lens_of(name, some).directions(points)
    )
    with pytest.raises(ConfigError, match=rf"{name}.*{sent} coefficients"):
        lens_of(name, (*padded[:-1], 0.1))


@pytest.mark.parametrize("name", ["ftheta", "omnidirectional", "double_sphere"])
def test_lenses_that_nobody_here_knows_are_refused_even_with_zeros(name):
    with pytest.raises(ConfigError, match=rf"'{name}'.*known are plumb_bob, rational_polynomial"):
        lens_of(name, (0.0,) * 4)
