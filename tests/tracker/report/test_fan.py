import numpy as np
import pytest

from tracker.report.fan import direction, fan


def test_a_direction_is_as_uncertain_as_the_place_is_across_the_ray():
    ray, across = np.array([0.6, 0.8]), np.array([-0.8, 0.6])
    covariance = 9.0 * np.outer(ray, ray) + 0.04 * np.outer(across, across)
    camera = np.array([1.0, -1.0])
    bearing_rad, std_rad = direction(camera + 4.0 * ray, covariance, camera)
    assert bearing_rad == pytest.approx(np.arctan2(0.8, 0.6))
    assert std_rad == pytest.approx(np.arctan2(0.2, 4.0))
    right_rad, left_rad = fan(camera + 4.0 * ray, covariance, camera)
    assert (right_rad + left_rad) / 2 == pytest.approx(bearing_rad)
    assert left_rad - right_rad == pytest.approx(4.0 * std_rad)


def test_an_exact_direction_is_still_to_be_seen():
    right_rad, left_rad = fan(np.array([2.0, 0.0]), np.zeros((2, 2)), np.zeros(2))
    assert left_rad - right_rad == pytest.approx(np.radians(2.0))


def test_somebody_at_the_camera_has_a_direction_without_a_warning():
    right_rad, left_rad = fan(np.zeros(2), np.eye(2), np.zeros(2))
    assert np.isfinite([right_rad, left_rad]).all()
