from dataclasses import replace

import numpy as np
import pytest

from tracker.containers import Hands
from tracker.perception.bodies.bodies import Bodies
from tracker.perception.bodies.owners import (
    arms_without_hand,
    find_owners,
    hand_size_px,
    sure_owners,
)

UP = {"right_elbow": (150, 105), "right_wrist": (148, 70)}


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


def test_a_hand_at_the_head_of_a_body_whose_wrist_is_lost_is_that_bodys(body, upright_hand):
    lost, seen = body(right_wrist=None), body(shift_px=(40, 0))
    at_ear = upright_hand((183, 73))
    assert find_owners(at_ear, Bodies.concatenate(seen, lost)).tolist() == [1]
    assert find_owners(at_ear, seen).tolist() == [-1]
    assert find_owners(upright_hand((183, 73), palm_px=2.0), lost).tolist() == [-1]


def test_an_owner_is_sure_where_the_wrists_nearly_meet(body, upright_hand):
    beside = upright_hand((166, 70))  # 0.45 widths of the shoulders from the wrist
    assert sure_owners(upright_hand((150, 72)), body(**UP)).tolist() == [0]
    assert sure_owners(beside, body(**UP)).tolist() == [-1]
    assert find_owners(beside, body(**UP)).tolist() == [0]
    assert sure_owners(upright_hand((183, 73)), body(right_wrist=None)).tolist() == [-1]


def test_a_right_hand_is_not_a_neighbors_left(body, upright_hand):
    neighbor, owner = body(left_wrist=(150, 70)), body(right_wrist=(158, 70))
    right = upright_hand((150, 72))
    left = replace(right, right=np.zeros(1))
    both = Bodies.concatenate(neighbor, owner)
    assert find_owners(right, both).tolist() == sure_owners(right, both).tolist() == [1]
    assert find_owners(left, both).tolist() == sure_owners(left, both).tolist() == [0]


def test_nobody_has_two_right_hands(body, upright_hand):
    both_up = body(right_wrist=(150, 70), left_wrist=(250, 70))
    hands = Hands.concatenate(upright_hand((151, 72)), upright_hand((252, 71)))
    assert find_owners(hands, both_up).tolist() == [0, 0]
    assert sure_owners(hands, both_up).tolist() == [0, -1]
    left_too = replace(hands, right=np.array([1.0, 0.0]))
    assert sure_owners(left_too, both_up).tolist() == [0, 0]
    mirrored = replace(hands, right=np.array([0.0, 1.0]))
    assert sure_owners(mirrored, both_up).tolist() == [0, 0]


def test_a_fist_is_as_large_as_its_palm_says(upright_hand):
    fist = upright_hand((100, 100), palm_px=10.0)
    landmarks = fist.landmarks_px.copy()
    landmarks[0, 12] = (100, 93)
    assert hand_size_px(replace(fist, landmarks_px=landmarks)) == pytest.approx(19.0)


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
