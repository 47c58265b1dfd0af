import numpy as np
import pytest

from tracker.config import Config
from tracker.perception.bodies import Bodies
from tracker.perception.pose_rules import judge_arms

UP = {"right_elbow": (150, 105), "right_wrist": (148, 70)}  # 30 px, 0.75 widths, above


def raised(bodies, **changes):
    return judge_arms(bodies, Config().replace(**changes))[0].tolist()


def test_arms_that_hang_are_down_and_measure_below_zero(body):
    verdict, rise = judge_arms(body(), Config())
    assert verdict.tolist() == [[False, False]]
    np.testing.assert_allclose(rise, [[-1.45, -1.45]])


def test_a_wrist_above_the_shoulder_is_up(body):
    verdict, rise = judge_arms(body(**UP), Config())
    assert verdict.tolist() == [[False, True]]
    np.testing.assert_allclose(rise[0, 1], 0.75)


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
    verdict, rise = judge_arms(body(**{**UP, hidden: None}), Config())
    assert not verdict[0, 1]
    assert np.isnan(rise[0, 1])


def test_without_a_head_the_rise_alone_decides(body):
    head = dict.fromkeys(("nose", "left_eye", "right_eye", "left_ear", "right_ear"))
    assert raised(body(right_wrist=(195, 75), **head)) == [[False, True]]
