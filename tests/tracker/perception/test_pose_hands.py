import numpy as np

from tracker.config import Config
from tracker.containers import CameraImage
from tracker.perception import HandDetector
from tracker.perception.bodies import Bodies
from tracker.perception.pose_hands import PoseHands, draw_hands

SIZE = (640, 480)
UP = {"right_elbow": (150, 105), "right_wrist": (148, 70)}
BOTH = np.array([[True, True]])


class Seen:
    """A body detector that sees the same people always."""

    def __init__(self, bodies):
        self.bodies = bodies
        self.was_reset = False
        self.config = None

    def find(self, image):
        return self.bodies

    def reset(self):
        self.was_reset = True

    def configure(self, config):
        self.config = config


def image():
    return CameraImage(0, "", np.zeros((480, 640, 3), np.uint8))


def test_each_wrist_is_a_hand_and_the_arm_decides(body):
    hands = PoseHands(Seen(body(**UP)), Config()).find(image())
    np.testing.assert_allclose(hands.wrist_px, [[226, 158], [148, 70]])
    assert hands.raised.tolist() == [False, True]
    assert hands.right.tolist() == [0.0, 1.0]
    np.testing.assert_allclose(hands.torso_px, [[200, 128], [200, 128]])


def test_who_was_not_looked_at_in_this_image_has_no_hands(body):
    people = Bodies.concatenate(body(**UP), body(age_s=0.1, shift_px=(200, 0), **UP))
    assert len(PoseHands(Seen(people), Config()).find(image())) == 2


def test_a_wrist_that_is_not_seen_is_no_hand(body):
    hands = PoseHands(Seen(body(left_wrist=None)), Config()).find(image())
    assert hands.right.tolist() == [1.0]
    assert len(PoseHands(Seen(body(left_shoulder=None)), Config()).find(image())) == 0


def test_the_hand_continues_the_forearm_in_the_size_of_the_body(body):
    hands = draw_hands(body(**UP), BOTH, SIZE, Config())
    forearm = np.array([148, 70]) - (150, 105)
    along = hands.landmarks_px[1, 12] - hands.wrist_px[1]
    np.testing.assert_allclose(
        along / np.linalg.norm(along), forearm / np.linalg.norm(forearm), atol=1e-9
    )
    np.testing.assert_allclose(hands.length_px, 2.0 * 0.26 * 40.0)


def test_without_an_elbow_the_fingers_point_up(body):
    hands = draw_hands(body(right_wrist=(148, 70), right_elbow=None), BOTH, SIZE, Config())
    np.testing.assert_allclose(hands.landmarks_px[1, 12, 0], 148)
    assert hands.landmarks_px[1, 12, 1] < 70


def test_the_thumb_is_on_the_bodys_side(body):
    both_up = body(**UP, left_elbow=(250, 105), left_wrist=(252, 70))
    left, right = draw_hands(both_up, BOTH, SIZE, Config()).landmarks_px
    assert left[4, 0] < left[20, 0]
    assert right[4, 0] > right[20, 0]


def test_the_measure_is_that_of_the_rule_in_force(body):
    palms = draw_hands(body(**UP), BOTH, SIZE, Config(raise_rule="palm")).raise_measure
    shares = draw_hands(body(**UP), BOTH, SIZE, Config(raise_rule="image")).raise_measure
    np.testing.assert_allclose(palms[1], 2.0, atol=0.01)  # the schematic hand is two palms long
    np.testing.assert_allclose(shares[1], 2.0 * 0.26 * 40.0 / 480, rtol=0.01)


def test_nobody_has_no_hands():
    assert len(PoseHands(Seen(Bodies.none()), Config()).find(image())) == 0


def test_reset_and_parameters_reach_the_bodies(body):
    seen = Seen(body(**UP))
    detector = PoseHands(seen, Config())
    assert isinstance(detector, HandDetector)
    detector.reset()
    detector.configure(Config(pose_raised_threshold=2.0))
    assert seen.was_reset
    assert seen.config == Config(pose_raised_threshold=2.0)
    assert not detector.find(image()).raised.any()
