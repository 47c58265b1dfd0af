import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tracker import Config, Measurements, PersonTracker
from tracker.service import approach_pose, customer_pose


@pytest.fixture
def tracks():
    """One selected customer at (3, 4), measured three times with 5 cm of noise."""
    tracker = PersonTracker()
    claims = Measurements.cartesian([[3.0, 4.0]], 0.05**2 * np.eye(2))
    for number in range(3):
        result = tracker.step(number * 100_000_000, claims)
    return result


ROBOT = np.array([0.0, 0.0])


def test_equations_5_to_10_the_customer_faces_the_robot(tracks):
    pose = customer_pose(tracks, ROBOT, "map", Config())
    assert pose.position_m == pytest.approx((3.0, 4.0, 0.0))
    # From (3, 4) the robot at the origin lies along (-3, -4) / 5.
    facing = Rotation.from_quat(pose.quaternion_xyzw).apply([1.0, 0.0, 0.0])
    assert facing == pytest.approx([-0.6, -0.8, 0.0])
    assert pose.frame_id == "map"


def test_the_approach_pose_stands_in_front_of_the_customer_and_faces_them(tracks):
    pose = approach_pose(customer_pose(tracks, ROBOT, "map", Config()), ROBOT, 1.0)
    assert pose.position_m == pytest.approx((2.4, 3.2, 0.0))
    facing = Rotation.from_quat(pose.quaternion_xyzw).apply([1.0, 0.0, 0.0])
    assert facing == pytest.approx([0.6, 0.8, 0.0])


def test_an_uncertain_customer_has_no_pose(tracks):
    assert customer_pose(tracks, ROBOT, "map", Config(pose_max_std_m=0.01)) is None


def test_a_customer_who_was_not_measured_lately_has_no_pose():
    tracker = PersonTracker(Config(lower_streak=100))
    claims = Measurements.cartesian([[3.0, 4.0]], 0.05**2 * np.eye(2))
    for number in range(3):
        tracker.step(number * 100_000_000, claims)
    config = Config(pose_max_age_s=0.5, pose_max_std_m=10.0)
    fresh = tracker.step(600_000_000, Measurements.none())
    stale = tracker.step(800_000_000, Measurements.none())
    assert customer_pose(fresh, ROBOT, "map", config) is not None
    assert stale.selected_id is not None
    assert customer_pose(stale, ROBOT, "map", config) is None


def test_nobody_selected_is_no_pose():
    tracks = PersonTracker().step(0, Measurements.none())
    assert customer_pose(tracks, ROBOT, "map", Config()) is None
