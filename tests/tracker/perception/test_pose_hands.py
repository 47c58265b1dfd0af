import numpy as np
import pytest

from tracker.config import Config
from tracker.containers import CameraImage
from tracker.perception import HandDetector
from tracker.perception.bodies.bodies import Bodies
from tracker.perception.pose_hands import PoseHands, draw_hands, judge_arms

SIZE = (640, 480)
UP = {"right_elbow": (150, 105), "right_wrist": (148, 70)}  # 30 px, 0.75 widths, above
BOTH = np.array([[True, True]])


class Seen:
    """A look that sees the same people always, and cannot follow them."""

    def __init__(self, bodies):
        self.bodies = bodies
        self.config = None

    def windows(self, width, height):
        return [(0, 0, width, height)]

    def around(self, bgr, window, known, most):
        return self.bodies

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
    assert hands.seated.tolist() == [0.0, 0.0]


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


def test_parameters_reach_the_model(body):
    seen = Seen(body(**UP))
    detector = PoseHands(seen, Config())
    assert isinstance(detector, HandDetector)
    detector.configure(Config(pose_raised_threshold=2.0))
    assert seen.config == Config(pose_raised_threshold=2.0)
    assert not detector.find(image()).raised.any()


def raised(bodies, **changes):
    return judge_arms(bodies, Config().replace(**changes)).tolist()


def test_arms_that_hang_are_down(body):
    assert raised(body()) == [[False, False]]


@pytest.mark.parametrize(("threshold", "up"), [(0.74, True), (0.76, False)])
def test_the_threshold_is_in_widths_of_the_shoulders(body, threshold, up):
    assert raised(body(**UP), pose_raised_threshold=threshold) == [[False, up]]


def test_the_verdict_does_not_depend_on_the_distance(body):
    near = body(**UP)
    far = Bodies.seen_now(near.points_px / 4.0, near.visibility, near.score)
    assert raised(far) == raised(near) == [[False, True]]


@pytest.mark.parametrize(
    "wrist",
    [(183, 72), (195, 75), (192, 38)],
    ids=["telephone at the ear", "cup at the mouth", "scratching the head"],
)
def test_a_hand_at_the_head_is_not_up(body, wrist):
    assert raised(body(right_wrist=wrist)) == [[False, False]]


def test_a_straight_arm_beside_the_head_is_up(body):
    assert raised(body(right_wrist=(178, 20))) == [[False, True]]


@pytest.mark.parametrize("hidden", ["right_wrist", "right_shoulder"])
def test_an_arm_that_is_not_seen_is_down(body, hidden):
    assert raised(body(**{**UP, hidden: None})) == [[False, False]]


def test_without_a_head_the_rise_alone_decides(body):
    head = dict.fromkeys(("nose", "left_eye", "right_eye", "left_ear", "right_ear"))
    assert raised(body(right_wrist=(195, 75), **head)) == [[False, True]]
