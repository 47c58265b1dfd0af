import numpy as np
import pytest

from tracker.simulation.posed_hand import BONES_MM, LENGTH_MM, HandPose, hand_points


@pytest.fixture
def open_hand():
    return HandPose(np.zeros((1, 4, 3)), np.zeros((1, 4)), np.radians([[45.0, 10.0, 0.0, 0.0]]))


def test_an_open_hand_is_as_long_as_a_hand(open_hand):
    points = hand_points(open_hand)[0]
    assert np.linalg.norm(points[12] - points[0]) == pytest.approx(1.0, abs=0.01)
    assert (points[[8, 12, 16, 20], 1] > points[[5, 9, 13, 17], 1]).all()


def test_the_thumb_lies_to_the_right_of_a_right_hand_s_palm(open_hand):
    points = hand_points(open_hand)[0]
    assert points[4, 0] > points[8, 0] > points[20, 0]


def test_bones_keep_their_length_however_the_joints_bend():
    rng = np.random.default_rng(1)
    pose = HandPose(
        rng.uniform(0.0, 1.5, (20, 4, 3)), rng.normal(0.0, 0.1, (20, 4)),
        rng.uniform(0.0, 1.0, (20, 4)),
    )  # fmt: skip
    points = hand_points(pose)
    for finger in range(4):
        chain = points[:, 5 + 4 * finger : 9 + 4 * finger]
        lengths = np.linalg.norm(np.diff(chain, axis=1), axis=-1) * LENGTH_MM
        np.testing.assert_allclose(lengths, np.tile(BONES_MM[finger], (20, 1)))


def test_bent_fingers_come_before_the_palm(open_hand):
    bent = open_hand._replace(bend=np.full((1, 4, 3), np.radians([80.0, 90.0, 40.0])))
    points = hand_points(bent)[0]
    assert (points[[8, 12, 16, 20], 1] < points[[5, 9, 13, 17], 1]).all()
    assert (points[[6, 10, 14, 18], 2] > 0.1).all()
