from dataclasses import replace

import numpy as np
import pytest

from tracker.containers import Hands
from tracker.perception.bodies.bodies import Bodies
from tracker.perception.verdict.evidence import Seen, gather_evidence
from tracker.perception.verdict.weights import NAMES

UP = {"right_elbow": (150, 105), "right_wrist": (148, 70)}


def evidence(hands, bodies=None, *, is_found=True, owner=0, is_asked=False, swing=0.0):
    bodies = Bodies.none() if bodies is None else bodies
    rows = len(hands)
    owner = owner if len(bodies) else -1
    seen = Seen(*(np.full(rows, value) for value in (is_found, owner, is_asked, swing)))
    rows = gather_evidence(hands, bodies, seen)
    return dict(zip(NAMES, rows[0].tolist(), strict=True)) if len(hands) == 1 else rows


def shaped(hand, **points):
    """A hand with some landmarks elsewhere, by row."""
    landmarks = hand.landmarks_px.copy()
    for row, place in points.items():
        landmarks[0, int(row[1:])] = place
    return replace(hand, landmarks_px=landmarks)


def test_every_quantity_has_a_column(body, upright_hand):
    hands = Hands.concatenate(upright_hand((148, 70)), upright_hand((148, 70)))
    assert evidence(hands, body(**UP)).shape == (2, len(NAMES))
    assert evidence(Hands.none(), body()).shape == (0, len(NAMES))


def test_what_was_not_seen_says_nothing(upright_hand):
    alone = evidence(upright_hand((148, 70)), is_found=False)
    assert set(alone.values()) == {0.0}


def test_an_owner_looked_for_in_vain_is_told_from_one_not_looked_for(upright_hand):
    hand = upright_hand((148, 70))
    assert evidence(hand, is_asked=True)["unowned"] == 1.0
    assert evidence(hand)["unowned"] == 0.0


def test_a_hand_rises_or_leans_as_its_landmarks_do(upright_hand):
    up = evidence(upright_hand((148, 70)))
    aside = evidence(shaped(upright_hand((100, 100)), p9=(110, 100), p12=(119, 100)))
    assert (up["rise"], up["lean"]) == pytest.approx((0.9, 0.0))
    assert aside["rise"] == pytest.approx(-1.0)
    assert aside["lean"] == pytest.approx(np.pi / 2)


def test_a_thumb_speaks_for_an_open_hand_and_against_a_closed_one(upright_hand):
    hand = upright_hand((100, 100))
    joints = {f"p{row}": (100, 86) for row in (6, 10, 14, 18)}
    thumb_out = {"p4": (120, 90), "p17": (95, 91)}
    palm = shaped(hand, **joints, **thumb_out, **{f"p{row}": (100, 81) for row in (8, 12, 16, 20)})
    fist = shaped(hand, **joints, **thumb_out, **{f"p{row}": (100, 93) for row in (8, 12, 16, 20)})
    assert evidence(palm)["spread"] == pytest.approx(1.0)
    assert evidence(palm)["thumb"] == 0.0
    assert evidence(fist)["thumb"] > 0.8
    assert evidence(fist)["spread"] == 0.0


def test_what_landmarks_of_few_pixels_say_of_fingers_counts_little(body, upright_hand):
    def fist(palm_px):
        bent = upright_hand((148, 98), palm_px=palm_px)
        shift = {f"p{row}": (148, 98 - 1.2 * palm_px) for row in (6, 10, 14, 18)}
        tips = {f"p{row}": (148, 98 - 0.6 * palm_px) for row in (8, 12, 16, 20)}
        return evidence(shaped(bent, **shift, **tips), body(right_wrist=(148, 98)))

    assert fist(5.0)["fist_low"] == 0.0 < 0.5 < fist(12.0)["fist_low"]


@pytest.mark.parametrize(
    ("wrist", "low", "high"),
    [((148, 70), 0.0, 0.75), ((148, 120), 0.5, 0.0)],
    ids=["above the shoulder", "below"],
)
def test_the_wrist_is_measured_from_the_shoulders(body, upright_hand, wrist, low, high):
    seen = evidence(upright_hand(wrist), body(right_wrist=wrist))
    assert (seen["low"] + seen["palm_low"], seen["high"]) == pytest.approx((low, high))


def test_a_wrist_above_the_head_is_overhead(body, upright_hand):
    seen = evidence(upright_hand((178, 35)), body(right_wrist=(178, 35)))
    assert seen["overhead"] == pytest.approx(0.5)  # the eyes are 20 px lower
    assert evidence(upright_hand((148, 70)), body(**UP))["overhead"] == 0.0


@pytest.mark.parametrize(
    ("elbow", "forearm"), [((148, 105), 1.0), ((178, 70), 0.0), ((148, 35), -1.0), (None, 0.0)]
)
def test_the_forearm_is_upright_level_hanging_or_not_seen(body, upright_hand, elbow, forearm):
    somebody = body(right_wrist=(148, 70), right_elbow=elbow)
    assert evidence(upright_hand((148, 70)), somebody)["forearm"] == pytest.approx(forearm)


def test_a_hand_at_the_ear_is_nearer_to_the_head_than_one_beside_it(body, upright_hand):
    at_ear = evidence(upright_hand((183, 75)), body(right_wrist=(183, 75)))
    beside = evidence(upright_hand((148, 70)), body(**UP))
    assert at_ear["head"] > 0.5 > beside["head"]


def test_hands_before_the_body_and_together_are_told(body, upright_hand):
    praying = body(right_wrist=(196, 110), left_wrist=(204, 110))
    seen = evidence(upright_hand((196, 110)), praying)
    assert seen["inside"] > 0.7
    assert seen["together"] > 0.7
    apart = evidence(upright_hand((148, 70)), body(**UP))
    assert (apart["inside"], apart["together"]) == (0.0, 0.0)


def test_a_body_that_is_hardly_seen_is_hardly_a_person(body, upright_hand):
    whole = evidence(upright_hand((148, 70)), body(**UP))
    head = dict.fromkeys(("nose", "left_eye", "right_eye", "left_ear", "right_ear"))
    headless = evidence(upright_hand((148, 70)), body(**UP, **head, score=0.6))
    assert whole["doubt"] == 0.0
    assert headless["doubt"] == 1.0


def test_doubt_about_a_body_counts_more_where_no_hand_was_found(body, upright_hand):
    unsure = body(**UP, score=0.85)
    assert evidence(upright_hand((148, 70)), unsure)["faint"] == 0.0
    assert evidence(upright_hand((148, 70)), unsure, is_found=False)["faint"] > 0.4


def test_all_lengths_of_the_arm_are_in_widths_of_the_shoulders(body, upright_hand):
    near = body(**UP)
    far = replace(near, points_px=near.points_px / 4.0)
    names = ("low", "high", "overhead", "forearm", "head", "inside", "together")
    there = evidence(upright_hand((37, 17.5), palm_px=2.5), far)
    here = evidence(upright_hand((148, 70)), near)
    assert [there[name] for name in names] == pytest.approx([here[name] for name in names])


def test_a_palm_that_is_shown_beside_the_head_is_told_from_one_on_it(body, upright_hand):
    hand = upright_hand((170, 72), palm_px=12.0)
    joints = {f"p{row}": (170, 55) for row in (6, 10, 14, 18)}
    palm = shaped(hand, **joints, **{f"p{row}": (170, 48) for row in (8, 12, 16, 20)})
    beside = evidence(palm, body(right_wrist=(170, 72)))
    on_head = evidence(
        replace(palm, landmarks_px=palm.landmarks_px + np.array([18.0, 0.0])),
        body(right_wrist=(188, 72)),
    )
    assert beside["head"] == 0.0
    assert on_head["head"] > 0.4


def test_a_palm_that_waves_past_the_head_is_not_on_it(body, upright_hand):
    hand = upright_hand((188, 72), palm_px=12.0)
    joints = {f"p{row}": (188, 55) for row in (6, 10, 14, 18)}
    palm = shaped(hand, **joints, **{f"p{row}": (188, 48) for row in (8, 12, 16, 20)})
    owner = body(right_elbow=(188, 102), right_wrist=(188, 72))
    still, waving = (evidence(palm, owner, swing=swing) for swing in (0.0, 1.0))
    assert still["head"] > 0.4
    assert waving["head"] < 0.1


def test_a_wave_is_a_hand_above_the_shoulder_or_a_palm_on_an_upright_arm(body, upright_hand):
    low = {"right_elbow": (150, 130), "right_wrist": (150, 102)}
    hand = upright_hand((150, 102))
    joints = {f"p{row}": (150, 88) for row in (6, 10, 14, 18)}
    palm = shaped(hand, **joints, **{f"p{row}": (150, 83) for row in (8, 12, 16, 20)})
    assert evidence(palm, body(**low), swing=1.0)["swing"] > 0.8
    assert evidence(hand, body(**low), swing=1.0)["swing"] < 0.5
    assert evidence(upright_hand((148, 70)), body(**UP), swing=1.0)["swing"] == 1.0


def test_a_fist_must_be_above_the_shoulder(body, upright_hand):
    hand = upright_hand((150, 98))
    joints = {f"p{row}": (150, 80) for row in (6, 10, 14, 18)}
    fist = shaped(hand, **joints, **{f"p{row}": (150, 91) for row in (8, 12, 16, 20)})
    assert evidence(fist, body(right_wrist=(150, 98)))["fist_low"] > 0.5
    higher = replace(fist, landmarks_px=fist.landmarks_px - (0.0, 28.0))
    assert evidence(higher, body(right_wrist=(150, 70)))["fist_low"] == 0.0


def test_an_open_palm_without_an_arm_speaks_for_itself(body, upright_hand):
    hand = upright_hand((148, 70))
    joints = {f"p{row}": (148, 56) for row in (6, 10, 14, 18)}
    palm = shaped(hand, **joints, **{f"p{row}": (148, 51) for row in (8, 12, 16, 20)})
    assert evidence(palm)["alone"] > 0.8
    assert evidence(palm, body(**UP))["alone"] == 0.0
    assert evidence(palm, body(right_elbow=None, right_wrist=(148, 70)))["alone"] > 0.8
    assert evidence(replace(palm, score=[0.5]))["alone"] == pytest.approx(0.0)
