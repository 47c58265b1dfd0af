"""The camera model against OpenCV's projection, which goes the other way."""

import math

import cv2
import numpy as np
import pytest

from tracker.camera import CameraModel, Sensor
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


@pytest.mark.parametrize(("model", "coefficients"), LENSES.values(), ids=LENSES.keys())
def test_pixels_are_where_opencv_projects_rays(model, coefficients):
    right, down, forward = points_ahead().T
    body = np.stack([forward, -right, -down], -1)
    camera = CameraModel(FX, FY, CX, CY, coefficients, model)
    expected = project(points_ahead(), model, coefficients)
    np.testing.assert_allclose(camera.pixels(body), expected, atol=1e-6)


def test_nothing_behind_a_straight_lens_is_seen():
    camera = CameraModel(FX, FY, CX, CY)
    assert np.isnan(camera.pixels([[-1.0, 0.2, 0.1], [0.0, 1.0, 0.0]])).all()


@pytest.mark.parametrize("k", [0.25, 0.5, 1.5, 3.0])
def test_a_resized_picture_sees_the_same_rays(k):
    lens = (-0.2, 0.05, 0.001, 0.0, 0.0)
    camera = CameraModel(700.0, 690.0, 655.0, 352.0, lens, "plumb_bob", 1280, 720)
    resized = camera.for_picture(round(1280 * k), round(720 * k))
    assert (resized.width, resized.height) == (1280 * k, 720 * k)
    pixels = np.array([[100.0, 60.0], [1200.0, 700.0], [640.0, 10.0]])
    np.testing.assert_allclose(resized.rays(pixels * k), camera.rays(pixels), atol=1e-9)


def test_a_picture_rounded_by_a_pixel_or_padded_by_a_macroblock_is_the_same_picture():
    camera = CameraModel(1400.0, 1400.0, 960.0, 540.0, width=1920, height=1080)
    assert camera.for_picture(427, 240).fx == pytest.approx(1400 * 427 / 1920)
    assert camera.for_picture(1920, 1088).fx == 1400.0


@pytest.mark.parametrize("size", [(640, 480), (1080, 1920), (1920, 1200), (1440, 1080)])
def test_a_picture_of_another_shape_is_refused_with_both_sizes(size):
    camera = CameraModel(1400.0, 1400.0, 960.0, 540.0, width=1920, height=1080)
    with pytest.raises(ConfigError, match=rf"1920x1080 .* {size[0]}x{size[1]}.*not a scaled copy"):
        camera.for_picture(*size)


def test_a_picture_larger_than_its_region_of_the_sensor_is_refused():
    camera = CameraModel(
        500.0, 500.0, 100.0, 80.0, width=320, height=240, sensor=Sensor(-200, -160, 640, 480)
    )
    assert camera.for_picture(160, 120).sensor == Sensor(-100, -80, 320, 240)
    with pytest.raises(ConfigError, match="a region of interest of 320x240"):
        camera.for_picture(640, 480)


def test_intrinsics_of_no_known_size_belong_to_whatever_comes():
    camera = CameraModel(FX, FY, CX, CY).for_picture(800, 600)
    assert (camera.fx, camera.cx, camera.width, camera.height) == (FX, CX, 800, 600)


@pytest.mark.parametrize(
    ("cx", "cy", "is_centered"),
    [
        (655.0, 340.0, True),
        (700.0, 360.0, True),
        (480.0, 270.0, False),  # of 960x540
        (800.0, 450.0, False),  # of 1600x900
        (640.0, 240.0, False),
    ],
)
def test_the_principal_point_tells_whose_size_the_intrinsics_have(cx, cy, is_centered):
    assert CameraModel(700.0, 700.0, cx, cy, (), "", 1280, 720).is_centered is is_centered


def test_of_a_region_the_whole_sensor_s_middle_counts():
    sensor = Sensor(-900.0, -600.0, 1920.0, 1200.0)
    corner = CameraModel(900.0, 900.0, 60.0, 0.0, (), "", 400, 300, sensor)
    assert corner.is_centered
    assert corner.middle_px == (60.0, 0.0)
