import numpy as np
import pytest

from tracker import Config, Hands, Measurements, Scan
from tracker.camera import CameraModel
from tracker.evaluation.trials.stated_noise import restate
from tracker.geometry import RigidTransform
from tracker.ranging import locate_scan, measure_people

CAMERA = CameraModel(460.0, 460.0, 320.0, 240.0)


def two_hands():
    """One ahead, where somebody stands, and a tiny one where the scan shows nobody."""
    landmarks = np.full((2, 21, 2), 100.0)
    landmarks[0, :, 0], landmarks[1, :, 0] = 320.0, 60.0
    landmarks[:, 12, 1] -= 60.0
    landmarks[0, 9, 1] -= 30.0
    one = np.ones(2)
    return Hands(landmarks, one, one, one.astype(bool), one)


def somebody_ahead():
    angles = np.radians(np.arange(720) / 2 - 180)
    ranges = np.where(np.abs(1.5 * np.tan(np.clip(angles, -1, 1))) < 0.2, 1.5, 5.0)
    scan = Scan(0, "laser", -np.pi, np.radians(0.5), 0.05, 12.0, ranges)
    return locate_scan(scan, RigidTransform())


def test_restated_noise_is_what_ranging_states_under_that_configuration():
    told = Config(arm_reach_m=0.2)  # so that the tiny hand is nobody's
    wanted = told.replace(range_std_m=0.15, hand_offset_std_m=0.07)
    measured, expected = (
        measure_people(two_hands(), CAMERA, RigidTransform(), somebody_ahead(), config)
        for config in (told, wanted)
    )
    assert np.isnan(expected.values[:, 1]).sum() == 1
    assert len(expected) >= 2
    found = restate(measured, wanted, told.hand_offset_std_m)
    np.testing.assert_allclose(found.covariance, expected.covariance, rtol=1e-12)
    np.testing.assert_array_equal(found.values, expected.values)


def test_what_a_hand_s_size_has_told_keeps_its_noise():
    measured = measure_people(two_hands()[:1], CAMERA, RigidTransform(), None, Config())
    found = restate(measured, Config(range_std_m=0.3), None)
    np.testing.assert_array_equal(found.covariance, measured.covariance)


def test_positions_keep_their_noise():
    claims = Measurements.cartesian([[1.0, 2.0]], 0.04 * np.eye(2))
    found = restate(claims, Config(range_std_m=0.3), 0.2)
    np.testing.assert_array_equal(found.covariance, claims.covariance)


def test_noise_that_no_sensor_can_have_is_never_restated():
    near = Measurements.polar([0.1, 0.2], [0.01, np.nan], 0.01, 0.1)
    widest, surest = Config(range_std_m=2.0), Config(hand_offset_std_m=0.0)
    assert restate(near, widest, 0.2).covariance[0, 0, 0] == pytest.approx(np.pi**2 / 3)
    assert restate(near, surest, 0.2).covariance[1, 0, 0] == pytest.approx(1e-8)
