from dataclasses import replace

import numpy as np
import pytest

from tracker.config import Config
from tracker.containers import Hands
from tracker.perception.bodies import Bodies
from tracker.perception.pose_rules import (
    arms_without_hand,
    clearance_of,
    find_owners,
    hands_at_head,
    hands_at_rest,
    hands_below_shoulders,
    hands_on_faces,
    judge_arms,
    owners_by_head,
)

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


def test_a_hand_belongs_to_the_body_with_the_nearest_wrist(body, upright_hand):
    people = Bodies.concatenate(body(shift_px=(-100, 0)), body(**UP))
    hands = Hands.concatenate(upright_hand((150, 72)), upright_hand((120, 158)))
    assert find_owners(hands, people).tolist() == [1, 0]


def test_a_hand_far_from_all_wrists_belongs_to_nobody(body, upright_hand):
    assert find_owners(upright_hand((148, 20)), body(**UP)).tolist() == [-1]
    assert find_owners(upright_hand((148, 20)), Bodies.none()).tolist() == [-1]
    assert len(find_owners(Hands.none(), body())) == 0


@pytest.mark.parametrize(
    ("length_px", "owner"), [(6.0, -1), (10.0, 0), (40.0, 0), (50.0, -1)],
    ids=["of a person far behind", "closed", "held to the camera", "of a person far in front"],
)  # fmt: skip
def test_a_hand_too_small_or_large_for_a_body_belongs_to_somebody_else(
    body, upright_hand, length_px, owner
):
    hand = upright_hand((150, 72), palm_px=length_px / 1.9)
    assert find_owners(hand, body(**UP)).tolist() == [owner]


def test_a_hand_passes_over_a_near_neighbor_to_its_owner(body, upright_hand):
    neighbor = body(**UP)
    owner = Bodies.seen_now(neighbor.points_px / 4.0, neighbor.visibility, neighbor.score)
    neighbor = replace(neighbor, points_px=neighbor.points_px - (110, 50))
    hand = upright_hand((38, 18), palm_px=3.0)  # 5.7 px, half the owner's shoulders
    assert find_owners(hand, Bodies.concatenate(neighbor, owner)).tolist() == [1]


def test_a_hand_without_owner_may_be_that_of_the_nearest_head_whose_wrist_is_lost(
    body, upright_hand
):
    lost, seen = body(right_wrist=None), body(shift_px=(40, 0))
    people, at_ear = Bodies.concatenate(seen, lost), upright_hand((183, 73))
    assert owners_by_head(at_ear, people, np.array([-1])).tolist() == [1]
    assert owners_by_head(at_ear, people, np.array([0])).tolist() == [0]
    assert owners_by_head(at_ear, seen, np.array([-1])).tolist() == [-1]
    assert owners_by_head(at_ear, Bodies.none(), np.array([-1])).tolist() == [-1]
    tiny = upright_hand((183, 73), palm_px=2.0)
    assert owners_by_head(tiny, lost, np.array([-1])).tolist() == [-1]


@pytest.mark.parametrize(
    ("wrist", "palm_px", "on_face"),
    [
        ((189, 62), 5.0, True),
        ((189, 75), 12.0, True),
        ((189, 100), 30.0, False),
        ((170, 62), 5.0, False),
    ],
    ids=["an ear", "a mouth", "of somebody nearer", "beside it, of somebody farther"],
)
def test_a_hand_without_owner_on_a_face_is_none_unless_it_would_hide_it(
    body, upright_hand, wrist, palm_px, on_face
):
    hand = upright_hand(wrist, palm_px=palm_px)
    assert hands_on_faces(hand, body(), np.array([-1])).tolist() == [on_face]
    assert hands_on_faces(hand, body(), np.array([0])).tolist() == [False]
    assert hands_on_faces(hand, Bodies.none(), np.array([-1])).tolist() == [False]


def test_the_reach_is_in_widths_of_the_shoulders(body, upright_hand):
    hand = upright_hand((168, 70))  # half a width beside the wrist
    reaches = 0.49, 0.51
    assert [find_owners(hand, body(**UP), reach)[0] for reach in reaches] == [-1, 0]


def test_an_arm_has_a_hand_where_one_was_found(body, upright_hand):
    somebody = body(**UP)
    assert arms_without_hand(Hands.none(), somebody).tolist() == [[True, True]]
    assert arms_without_hand(upright_hand((150, 72)), somebody).tolist() == [[True, False]]


def test_bodies_inside_a_large_hand_have_hands(body, upright_hand):
    close_up = upright_hand((200, 300), palm_px=200.0)
    assert arms_without_hand(close_up, body(**UP)).tolist() == [[False, False]]


@pytest.mark.parametrize(
    ("wrist", "at_head"),
    [((183, 75), True), ((165, 75), False), ((190, 42), False), ((187, 54), True)],
    ids=["telephone at the ear", "beside the head", "above the head", "scratching the crown"],
)
def test_a_hand_at_its_owners_head_is_told_from_one_beside_it(body, upright_hand, wrist, at_head):
    somebody, hand = body(right_wrist=wrist), upright_hand(wrist)
    assert hands_at_head(hand, somebody, np.array([0]), 0.4).tolist() == [at_head]


def test_the_head_of_another_one_may_be_behind_a_raised_hand(body, upright_hand):
    hand = upright_hand((183, 75))
    assert hands_at_head(hand, body(), np.array([-1]), 0.4).tolist() == [False]


def test_shoulders_are_the_yardstick_however_small_the_hand_model_takes_a_closed_hand(
    body, upright_hand
):
    wrist = (183, 75)
    tiny = upright_hand(wrist, palm_px=4.0)
    assert hands_at_head(tiny, body(right_wrist=wrist), np.array([0]), 0.4).tolist() == [True]


@pytest.mark.parametrize(
    ("knuckles_row", "below"), [(103, True), (101, False), (60, False)],
    ids=["before the chest", "at the shoulders", "beside the head"],
)  # fmt: skip
def test_a_hand_before_the_body_is_told_from_one_that_is_up(
    body, upright_hand, knuckles_row, below
):
    # Shoulders are 40 px wide, in row 100: 2 px below them is the limit.
    wrist = (160, knuckles_row + 10)
    hand, somebody = upright_hand(wrist, palm_px=10.0), body(right_wrist=wrist)
    assert hands_below_shoulders(hand, somebody, np.array([0]), -0.05).tolist() == [below]
    assert hands_below_shoulders(hand, body(), np.array([-1]), -0.05).tolist() == [False]


@pytest.mark.parametrize(
    ("wrist", "below"), [((176, 110), True), ((140, 110), False)], ids=["own", "another one's"]
)
def test_whoever_is_found_twice_has_a_hand_before_the_body_if_either_body_says_so(
    body, upright_hand, wrist, below
):
    hand = upright_hand((176, 110))  # its fingers' roots in the row of the shoulders, or above
    lower = body(right_wrist=(176, 90), shift_px=(0, 20))
    twice = Bodies.concatenate(lower, body(right_wrist=wrist, shift_px=(0, -1)))
    assert hands_below_shoulders(hand, lower, np.array([0]), 0.0).tolist() == [False]
    assert hands_below_shoulders(hand, twice, np.array([0]), 0.0).tolist() == [below]


@pytest.mark.parametrize(("middle_tip", "clearance"), [((100, 86), 0.5), ((100, 84), 0.4)])
def test_a_bent_hand_must_be_farther_from_the_head_than_one_stretched_upwards(
    upright_hand, middle_tip, clearance
):
    landmarks = upright_hand((100, 100), palm_px=10.0).landmarks_px.copy()
    landmarks[0, 12] = middle_tip
    hand = replace(upright_hand((100, 100)), landmarks_px=landmarks)
    assert clearance_of(hand, 0.4).tolist() == [clearance]


def test_a_hand_whose_owners_shoulders_are_hidden_is_not_refused(body, upright_hand):
    hidden = body(left_shoulder=None, right_wrist=(160, 160))
    hand = upright_hand((160, 160))
    assert hands_below_shoulders(hand, hidden, np.array([0]), -0.05).tolist() == [False]


@pytest.mark.parametrize(
    ("wrist", "resting"), [((188, 170), True), ((190, 220), True), ((160, 130), False)],
    ids=["at the hip", "at the knee", "beside the elbow"],
)  # fmt: skip
def test_a_hand_without_owner_at_a_hip_or_a_knee_rests_there(body, upright_hand, wrist, resting):
    hand, somebody = upright_hand(wrist), body(left_wrist=None, right_wrist=None)
    assert hands_at_rest(hand, somebody, np.array([-1])).tolist() == [resting]
    assert hands_at_rest(hand, somebody, np.array([0])).tolist() == [False]


def test_a_near_hand_before_the_hip_of_one_far_behind_does_not_rest_there(body, upright_hand):
    hand = upright_hand((188, 170), palm_px=40.0)
    assert hands_at_rest(hand, body(), np.array([-1])).tolist() == [False]


def test_a_hip_that_is_not_seen_holds_no_hand(body, upright_hand):
    hidden = body(right_hip=None, left_hip=None)
    assert hands_at_rest(upright_hand((188, 160)), hidden, np.array([-1])).tolist() == [False]
    assert hands_at_rest(upright_hand((188, 160)), Bodies.none(), np.array([-1])).tolist() == [
        False
    ]
