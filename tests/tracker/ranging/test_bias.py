"""What lasts of the error of a place lies along and across the line of sight."""

import numpy as np
import pytest

from tracker import Config
from tracker.ranging.bias import bias_covariance

WELL_MOUNTED = Config(mounting_std_deg=0.0, stamp_std_s=0.0)
STILL = np.zeros(3)


def test_it_turns_with_the_line_of_sight():
    ahead, aside = bias_covariance(
        np.array([0.0, np.pi / 2]),
        np.array([3.0, 3.0]),
        WELL_MOUNTED,
        along_m=0.3,
        across_m=0.1,
        motion=STILL,
    )
    assert ahead == pytest.approx(np.diag([0.09, 0.01]))
    assert aside == pytest.approx(np.diag([0.01, 0.09]))


def test_a_yaw_that_is_hardly_known_tells_far_off():
    config = WELL_MOUNTED.replace(mounting_std_deg=1.0)
    near, far = bias_covariance(
        np.zeros(2), np.array([1.0, 5.0]), config, along_m=0.0, across_m=0.0, motion=STILL
    )
    assert np.sqrt(near[1, 1]) == pytest.approx(np.deg2rad(1.0))
    assert np.sqrt(far[1, 1]) == pytest.approx(5.0 * np.deg2rad(1.0))
    assert far[0, 0] == pytest.approx(0.0)


def test_a_wrong_stamp_tells_as_far_as_the_sensors_move_meanwhile():
    config = WELL_MOUNTED.replace(stamp_std_s=0.05)
    for motion, shift_m in (
        ([0.0, 0.0, 1.0], [0.0, 0.05 * 6.0]),  # 50 ms at 1 rad/s are 30 cm at 6 m
        ([0.4, 0.0, 0.0], [0.05 * 0.4, 0.0]),
        ([0.0, -6.0, 1.0], [0.0, 0.0]),  # the place moves along with the sensors
    ):
        (found,) = bias_covariance(
            np.zeros(1), np.array([6.0]), config, along_m=0.0, across_m=0.0,
            motion=np.array(motion),
        )  # fmt: skip
        assert found == pytest.approx(np.outer(shift_m, shift_m))
