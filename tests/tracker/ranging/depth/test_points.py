import numpy as np
import pytest

from tracker.camera import CameraModel
from tracker.containers import DepthImage
from tracker.errors import ConfigError, ShapeError
from tracker.geometry import RigidTransform, euler_to_quaternion
from tracker.ranging.depth import depth_points

CAMERA = CameraModel(460.0, 460.0, 320.0, 240.0, width=640, height=480)


def test_every_reading_lies_where_the_surface_is(room, standing):
    points = depth_points(room(wall_m=3.0), CAMERA, standing)
    x_m, _, z_m = points.xyz_m
    on_wall = z_m > 0.05
    np.testing.assert_allclose(x_m[on_wall], 3.0, atol=1e-4)
    np.testing.assert_allclose(z_m[x_m < 2.95], 0.0, atol=1e-4)


def test_a_camera_that_looks_down_sees_the_wall_upright(room):
    pitch = np.radians(20.0)
    tilted = RigidTransform((0.0, 0.0, 1.2), euler_to_quaternion(0.0, pitch, 0.0))
    flat = DepthImage.of(1, "", np.full((480, 640), 2000, np.uint16))
    points = depth_points(flat, CAMERA, tilted)
    middle = np.argmin(np.abs(points.heading_rad) + np.abs(points.range_m - 2 * np.cos(pitch)))
    assert points.range_m[middle] == pytest.approx(2.0 * np.cos(pitch), abs=0.03)


def test_intrinsics_of_another_size_are_scaled():
    small = DepthImage.of(1, "", np.full((240, 320), 2.0, np.float32))
    large = DepthImage.of(1, "", np.full((480, 640), 2.0, np.float32))
    headings = [
        depth_points(each, CAMERA, RigidTransform()).heading_rad for each in (small, large)
    ]
    assert headings[0].min() == pytest.approx(headings[1].min(), abs=0.005)
    assert len(headings[0]) == len(headings[1])


@pytest.mark.parametrize(
    ("shape", "error"),
    [
        ((480, 640, 3), ShapeError),
        ((100, 640), ConfigError),
        ((1, 640), ShapeError),
        ((480, 1), ShapeError),
        ((1, 1), ShapeError),
    ],
    ids=["three channels", "another shape", "one row", "one column", "one pixel"],
)
def test_what_is_no_depth_image_of_this_camera_is_refused(shape, error):
    image = DepthImage.of(1, "", np.zeros(shape, np.float32))
    with pytest.raises(error):
        depth_points(image, CAMERA, RigidTransform())
