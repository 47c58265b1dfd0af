from dataclasses import replace

import numpy as np
import pytest

from tracker.simulation.activities import ACTIVITIES
from tracker.simulation.rendering.arm import bend_arm, raised_hand_landmarks, reach
from tracker.simulation.rendering.look import Look

STANDS, SITS = Look(), Look(seat_m=0.5)


@pytest.mark.parametrize("look", [STANDS, SITS], ids=["stands", "sits"])
@pytest.mark.parametrize("from_behind", [False, True], ids=["front", "back"])
def test_the_raised_hand_points_up_beside_the_body(look, from_behind):
    hand = raised_hand_landmarks(look, from_behind=from_behind)
    palm = np.linalg.norm(hand[9] - hand[0])
    assert (hand[12, 1] - hand[0, 1]) / palm > 1.6  # an open hand, by the palm rule
    assert 0.25 < abs(hand[0, 0]) < 0.5
    # A right hand is at the left of whoever faces its owner, and its thumb toward the head.
    assert np.sign(hand[0, 0]) == (1.0 if from_behind else -1.0)
    assert abs(hand[4, 0]) < abs(hand[20, 0])


def test_the_left_hand_mirrors_the_right():
    right, left = raised_hand_landmarks(Look()), raised_hand_landmarks(Look(right_handed=False))
    np.testing.assert_allclose(left, right * (-1.0, 1.0))


@pytest.mark.parametrize("look", [STANDS, SITS], ids=["stands", "sits"])
def test_a_lowered_hand_points_down(look):
    assert abs(bend_arm(look, 0.0, -1.0).hand_rad) > np.pi / 2


def test_a_seat_lowers_head_and_hand():
    drop = raised_hand_landmarks(STANDS)[0, 1] - raised_hand_landmarks(SITS)[0, 1]
    assert drop == pytest.approx(0.9 - 0.06 - 0.5)


@pytest.mark.parametrize("style", ["beside", "straight", "low"])
def test_a_hand_is_up_in_every_style(style):
    hand = raised_hand_landmarks(Look(raise_style=style))
    palm = np.linalg.norm(hand[9] - hand[0])
    assert (hand[12, 1] - hand[0, 1]) / palm > 1.6


def test_styles_differ_in_height():
    heights = [
        raised_hand_landmarks(Look(raise_style=style))[0, 1]
        for style in ("low", "beside", "straight")
    ]
    assert np.diff(heights).min() > 0.15


def test_a_hand_leans_outward_by_the_asked_angle():
    for right_handed, outward in ((True, -1.0), (False, 1.0)):
        look = Look(right_handed=right_handed)
        upright, leaning = (
            raised_hand_landmarks(item)[12] - raised_hand_landmarks(item)[0]
            for item in (look, replace(look, lean_deg=20.0))
        )
        turned = np.degrees(np.arctan2(*leaning) - np.arctan2(*upright))
        assert turned == pytest.approx(outward * 20.0)


@pytest.mark.parametrize("look", [STANDS, SITS], ids=["stands", "sits"])
@pytest.mark.parametrize("what", ACTIVITIES)
def test_no_bone_is_longer_than_it_is(what, look):
    bones = np.array([0.27, 0.24]) * look.scale
    for moment in ACTIVITIES[what]:
        for gesture in filter(None, (moment.hand, moment.other)):
            arm = reach(look, gesture.wrist_m, gesture.hand_deg, 1.0)
            joints = np.array([arm.shoulder_m, arm.elbow_m, arm.wrist_m])
            drawn = np.linalg.norm(np.diff(joints, axis=0), axis=-1)
            assert (drawn <= bones + 1e-9).all()


def test_the_hand_of_somebody_who_waves_goes_to_either_side():
    inward, outward = (raised_hand_landmarks(STANDS, swing=swing)[12, 0] for swing in (-1.0, 1.0))
    assert outward < raised_hand_landmarks(STANDS)[12, 0] < inward


def test_a_far_hand_is_at_the_end_of_a_stretched_arm():
    arm = reach(STANDS, (0.66, 1.36), 88.0, 1.0)
    along = np.subtract(arm.wrist_m, arm.shoulder_m)
    elbow = np.subtract(arm.elbow_m, arm.shoulder_m)
    assert abs(elbow[0] * along[1] - elbow[1] * along[0]) < 1e-9
