"""The camera model against OpenCV's projection, which goes the other way."""

import math

import cv2
import numpy as np
import pytest

from tracker.camera import CameraModel
from tracker.errors import ConfigError

FX, FY, CX, CY = 460.0, 455.0, 322.0, 241.0
MATRIX = np.array([[FX, 0.0, CX], [0.0, FY, CY], [0.0, 0.0, 1.0]])

LENSES = {
    "no distortion": ("", ()),
    "zeros": ("plumb_bob", (0.0, 0.0, 0.0, 0.0, 0.0)),
    "plumb bob of four": ("plumb_bob", (-0.12, 0.03, 0.001, -0.0008)),
    "plumb bob of five": ("plumb_bob", (-0.28, 0.09, 0.0005, 0.0003, -0.012)),
    "rational": ("rational_polynomial", (0.3, -0.05, 0.0004, 0.0002, 0.001, 0.6, -0.02, 0.003)),
    "equidistant": ("equidistant", (-0.02, 0.006, -0.004, 0.001)),
}


def points_ahead():
    """Points of the optical frame (x right, y down, z forward) that fill the picture."""
    columns, rows = np.meshgrid(np.linspace(-0.6, 0.6, 7), np.linspace(-0.45, 0.45, 5))
    depth = np.random.default_rng(1).uniform(0.5, 6.0, columns.size)
    return np.stack([columns.ravel(), rows.ravel(), np.ones(columns.size)], -1) * depth[:, None]


def project(points, model, coefficients):
    nowhere = np.zeros(3)
    if model == "equidistant":
        pixels, _ = cv2.fisheye.projectPoints(
            points[:, None], nowhere[None, None], nowhere[None, None], MATRIX,
            np.array(coefficients),
        )  # fmt: skip
    else:
        pixels, _ = cv2.projectPoints(
            points[:, None], nowhere, nowhere, MATRIX, np.array(coefficients)
        )
    return pixels.reshape(-1, 2)


@pytest.mark.parametrize(("model", "coefficients"), LENSES.values(), ids=LENSES.keys())
def test_undistorting_undoes_opencvs_projection(model, coefficients):
    points = points_ahead()
    camera = CameraModel(FX, FY, CX, CY, coefficients, model)
    ideal = points[:, :2] / points[:, 2:] * [FX, FY] + [CX, CY]
    np.testing.assert_allclose(
        camera.undistort(project(points, model, coefficients)), ideal, atol=0.1
    )


@pytest.mark.parametrize(("model", "coefficients"), LENSES.values(), ids=LENSES.keys())
def test_rays_point_back_at_what_was_projected(model, coefficients):
    right, down, forward = points_ahead().T
    body = np.stack([forward, -right, -down], -1)
    expected = body / np.linalg.norm(body, axis=-1, keepdims=True)
    camera = CameraModel(FX, FY, CX, CY, coefficients, model)
    rays = camera.rays(project(points_ahead(), model, coefficients))
    assert np.degrees(np.arccos(np.clip(np.sum(rays * expected, -1), -1, 1))).max() < 0.02


def test_the_principal_point_looks_straight_ahead():
    np.testing.assert_allclose(CameraModel(FX, FY, CX, CY).rays([[CX, CY]]), [[1.0, 0.0, 0.0]])


def test_a_pixel_one_focal_length_to_the_right_looks_45_degrees_to_the_right():
    half = math.sqrt(0.5)
    rays = CameraModel(FX, FY, CX, CY).rays([[CX + FX, CY]])
    np.testing.assert_allclose(rays, [[half, -half, 0.0]])


@pytest.mark.parametrize(("model", "coefficients"), LENSES.values(), ids=LENSES.keys())
def test_no_pixels_give_no_rays(model, coefficients):
    camera = CameraModel(FX, FY, CX, CY, coefficients, model)
    assert camera.rays(np.zeros((0, 2))).shape == (0, 3)


@pytest.mark.parametrize(
    "numbers",
    [
        (0.0, 0.0, 0.0, 0.0),
        (460.0, 0.0, 320.0, 240.0),
        (-460.0, 460.0, 320.0, 240.0),
        (math.nan, 460.0, 320.0, 240.0),
        (460.0, 460.0, math.inf, 240.0),
    ],
    ids=["all zero", "no fy", "negative fx", "NaN", "infinite"],
)
def test_unusable_intrinsics_are_refused_with_the_remedy(numbers):
    with pytest.raises(ConfigError, match=r"positive focal lengths.*use_camera_info: false"):
        CameraModel(*numbers)


def test_a_coefficient_that_is_no_number_is_refused():
    with pytest.raises(ConfigError, match="finite"):
        CameraModel(FX, FY, CX, CY, (math.nan, 0.0, 0.0, 0.0), "plumb_bob")


@pytest.mark.parametrize(
    ("model", "coefficients"),
    [("plumb_bob", (0.1, 0.2)), ("equidistant", (0.1,) * 5), ("", (0.1,) * 5), ("thin", ())],
)
def test_an_unknown_distortion_is_refused_with_the_known_ones(model, coefficients):
    with pytest.raises(ConfigError, match=r"plumb_bob, rational_polynomial, equidistant"):
        CameraModel(FX, FY, CX, CY, coefficients, model)


def test_the_picture_s_edges_are_the_bearings_of_their_pixels():
    camera = CameraModel(460.0, 470.0, 300.0, 240.0)
    right, left = camera.horizontal_span_rad(640)
    rays = camera.rays([[640.0, 240.0], [0.0, 240.0]])
    assert [right, left] == pytest.approx(np.arctan2(rays[:, 1], rays[:, 0]))
    assert right < 0.0 < left
