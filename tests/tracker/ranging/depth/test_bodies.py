import numpy as np
import pytest

from tracker import Config
from tracker.camera import CameraModel
from tracker.containers import SensorKind
from tracker.ranging.depth import body_measurements, depth_points, find_bodies

CAMERA = CameraModel(460.0, 460.0, 320.0, 240.0, width=640, height=480)
CONFIG = Config()


def bodies(image, pose, config=CONFIG):
    return find_bodies(depth_points(image, CAMERA, pose), config)


def test_people_are_found_before_a_wall_and_furniture_below_tables_is_not(room, standing):
    image = room(
        (2.0, 0.5, 0.2, 0.0, 1.7), (3.5, -0.8, 0.22, 0.0, 1.6), (1.5, -0.3, 0.4, 0.0, 0.75)
    )
    found = bodies(image, standing).people.xy_m
    assert len(found) == 2
    assert sorted(found.round(1).tolist()) == [[2.1, 0.5], [3.6, -0.8]]


def test_a_wall_a_pole_and_a_ceiling_lamp_are_nobody(room, standing):
    image = room((2.0, 0.5, 0.03, 0.0, 2.6), (2.0, -0.5, 0.3, 2.1, 2.5))
    assert len(bodies(image, standing).people) == 0


def test_pixels_that_mix_body_and_wall_make_nobody_and_move_nobody(room, standing):
    rng = np.random.default_rng(2)

    def mixing(depth):
        edge = np.abs(np.diff(depth, axis=1, prepend=depth[:, :1])) > 0.2
        edge |= np.roll(edge, -1, axis=1) | np.roll(edge, 1, axis=1)
        depth = np.where(edge, rng.uniform(2.0, 6.0, depth.shape), depth)
        return np.where(rng.random(depth.shape) < 0.3, np.nan, depth)

    found = bodies(room((2.0, 0.0, 0.2, 0.0, 1.7), noise=mixing), standing).people.xy_m
    assert len(found) == 1
    assert found[0] == pytest.approx([2.09, 0.0], abs=0.04)


def test_scattered_readings_of_a_sunny_room_are_nobody(room, standing):
    rng = np.random.default_rng(5)

    def sunny(depth):
        return np.where(rng.random(depth.shape) < 0.9, np.nan, rng.uniform(0.4, 9.0, depth.shape))

    assert len(bodies(room(noise=sunny), standing).people) == 0


def test_an_image_without_any_reading_shows_nobody(room, standing):
    found = bodies(room(noise=lambda depth: depth * np.nan), standing)
    assert len(found.people) == 0
    assert not found.slice.valid.any()


def test_bodies_claim_a_range_whose_noise_grows_with_its_square(room, standing):
    image = room((2.0, 0.5, 0.2, 0.0, 1.7), (4.0, -0.8, 0.22, 0.0, 1.6))
    found = bodies(image, standing)
    config = Config(depth_std_m=0.05, range_std_m=0.001)
    claims = body_measurements(found, np.ones(2, dtype=bool), 0.0, config)
    assert claims.kind.tolist() == [SensorKind.BEARING_RANGE] * 2
    assert not claims.raised.any()
    std = np.sqrt(claims.covariance[:, 1, 1])
    range_m = claims.values[:, 1]
    np.testing.assert_allclose(std, 0.05 * range_m**2, rtol=1e-3)


def test_claims_stand_where_the_bodies_do(room, standing):
    found = bodies(room((2.0, 0.5, 0.2, 0.0, 1.7)), standing)
    claims = body_measurements(found, np.ones(1, dtype=bool), 0.0, CONFIG)
    angle = claims.values[0, 0] + claims.sensor_pose[0, 2]
    place = claims.values[0, 1] * np.array([np.cos(angle), np.sin(angle)])
    np.testing.assert_allclose(place, found.people.xy_m[0], atol=1e-9)


def test_somebody_seen_a_moment_earlier_is_less_sure(room, standing):
    found = bodies(room((2.0, 0.5, 0.2, 0.0, 1.7)), standing)
    now, later = (
        body_measurements(found, np.ones(1, dtype=bool), off_s, CONFIG).covariance[0, 1, 1]
        for off_s in (0.0, 0.2)
    )
    assert later > now
