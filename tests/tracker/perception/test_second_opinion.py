from dataclasses import replace

import numpy as np
import pytest

from tracker.config import Config
from tracker.containers import CameraImage, Hands, PerceptionWork, Refusal
from tracker.perception import HandDetector
from tracker.perception.arm_watch import LOOK_PERIOD, LOOK_PLACES, ArmWatch
from tracker.perception.bodies import Bodies
from tracker.perception.owner_finder import OwnerFinder
from tracker.perception.second_opinion import SecondOpinion, weigh_opinions

SIZE = (640, 480)
UP = {"right_elbow": (150, 105), "right_wrist": (148, 70)}
PHONING = {"right_elbow": (165, 120), "right_wrist": (183, 78)}


def weigh(hands, bodies, opinion):
    return weigh_opinions(hands, bodies, SIZE, Config(pose_opinion=opinion))


@pytest.mark.parametrize("opinion", ["veto", "full"])
def test_a_raised_hand_at_its_owners_ear_is_not_raised(body, upright_hand, opinion):
    answer = weigh(upright_hand((183, 78)), body(**PHONING), opinion)
    assert answer.raised.tolist() == [False]


@pytest.mark.parametrize(("opinion", "torso_px"), [("veto", [np.nan] * 2), ("full", [200, 128])])
def test_a_raised_hand_beside_the_head_stays_and_may_learn_of_its_torso(
    body, upright_hand, opinion, torso_px
):
    answer = weigh(upright_hand((148, 70)), body(**UP), opinion)
    assert answer.raised.tolist() == [True]
    np.testing.assert_allclose(answer.torso_px, [torso_px])


@pytest.mark.parametrize("opinion", ["veto", "full"])
def test_a_hand_that_gestures_before_the_chest_is_not_raised(body, upright_hand, opinion):
    answer = weigh(upright_hand((160, 115)), body(right_wrist=(160, 115)), opinion)
    assert answer.raised.tolist() == [False]


def test_a_hand_in_a_lap_is_not_raised_even_where_its_owner_is_not_known(body, upright_hand):
    sitting = body(right_wrist=None, left_wrist=None)
    assert weigh(upright_hand((188, 170)), sitting, "veto").raised.tolist() == [False]


def unsure(hands):
    return replace(hands, raised=[False], pending=[True])


def test_a_pending_hand_is_raised_where_its_owners_pose_agrees(body, upright_hand):
    hand = unsure(upright_hand((148, 70)))
    assert weigh(hand, body(**UP), "veto").raised.tolist() == [True]
    assert weigh(hand, Bodies.none(), "veto").raised.tolist() == [False]


def test_a_body_refuses_hands_near_its_own_but_vouches_for_its_own_alone(body, upright_hand):
    beside = upright_hand((166, 70))  # 0.45 widths of the shoulders from the wrist
    assert weigh(beside, body(**UP), "veto").raised.tolist() == [True]
    assert weigh(unsure(beside), body(**UP), "veto").raised.tolist() == [False]
    below = upright_hand((166, 115))
    lowered = body(right_wrist=(148, 115))
    assert weigh(below, lowered, "veto").raised.tolist() == [False]


def test_a_pending_hand_at_its_owners_ear_is_not_raised(body, upright_hand):
    answer = weigh(unsure(upright_hand((183, 78))), body(**PHONING), "veto")
    assert answer.raised.tolist() == [False]


def raised_after(hand, look, config, images=30):
    """Images until it counts; None where it does not."""
    opinion = SecondOpinion(Always(hand), OwnerFinder(look), config)
    for number in range(images):
        image = CameraImage(number * 100_000_000, "", np.zeros((480, 640, 3), np.uint8))
        if opinion.find(image).raised.any():
            return number
    return None


def test_a_hand_waits_until_its_owner_was_looked_for_in_every_window(body, upright_hand):
    config = Config(owner_hand_px=0.0)
    hand = upright_hand((148, 70))
    assert raised_after(hand, lambda bgr, window: body(**UP), config) == 0
    assert raised_after(hand, lambda bgr, window: Bodies.none(), config) == 2
    far = upright_hand((400, 400))
    assert raised_after(far, lambda bgr, window: body(**UP), config) == 2


def test_a_small_hand_without_an_owner_waits_longer(upright_hand):
    config = Config(unowned_patience_s=1.0)
    hands = upright_hand((148, 70)), upright_hand((148, 270), palm_px=60.0)
    after = [raised_after(hand, lambda bgr, window: Bodies.none(), config) for hand in hands]
    assert after == [10, 2]


def test_a_large_hand_waits_as_long_where_the_lower_edge_cuts_its_forearm_off(upright_hand):
    config = Config(unowned_patience_s=1.0)
    hand = upright_hand((148, 420), palm_px=60.0)  # 114 px long
    assert raised_after(hand, lambda bgr, window: Bodies.none(), config) == 10


def test_a_small_unsure_hand_without_an_owner_never_counts(upright_hand):
    hand = replace(upright_hand((148, 70)), score=[0.7])
    assert raised_after(hand, lambda bgr, window: Bodies.none(), Config()) is None


def test_bodies_are_looked_for_in_the_picture_that_the_hands_models_saw(upright_hand):
    hands, looked = Told(upright_hand((148, 70))), []

    def look(bgr, window):
        looked.append(bgr)
        return Bodies.none()

    opinion = SecondOpinion(hands, OwnerFinder(look), Config())
    opinion.find(CameraImage(0, "", np.zeros((480, 640, 3), np.uint8)))
    assert looked[0] is hands.seen
    assert opinion.seen is hands.seen


def test_the_specifications_rule_is_not_vetoed(body, upright_hand):
    hands, bodies = Always(upright_hand((183, 78))), Always(body(**PHONING))
    opinion = SecondOpinion(hands, bodies, Config(raise_rule="image"))
    image = CameraImage(0, "", np.zeros((480, 640, 3), np.uint8))
    assert opinion.find(image) is hands.answer


def test_owners_are_looked_for_around_the_hands_just_found(body, upright_hand):
    owners = OwnerFinder(lambda bgr, window: body(**PHONING))
    opinion = SecondOpinion(Always(upright_hand((183, 78))), owners, Config())
    image = CameraImage(0, "", np.zeros((480, 640, 3), np.uint8))
    assert opinion.find(image).raised.tolist() == [False]


def test_a_hand_without_a_body_stays_as_it_is(upright_hand):
    hands = upright_hand((148, 70))
    answer = weigh(hands, Bodies.none(), "full")
    assert answer.raised.tolist() == [True]
    assert np.isnan(answer.torso_px).all()


def test_a_pose_never_raises_a_hand_that_the_hand_rule_calls_lowered(body, upright_hand):
    answer = weigh(upright_hand((148, 70), raised=False), body(**UP), "full")
    assert answer.raised.tolist() == [False]


def test_an_arm_that_is_up_without_a_hand_is_a_raised_hand_in_full(body):
    answer = weigh(Hands.none(), body(**UP), "full")
    assert answer.raised.tolist() == [True]
    np.testing.assert_allclose(answer.wrist_px, [[148, 70]])
    assert len(weigh(Hands.none(), body(**UP), "veto")) == 0


def test_an_arm_seen_up_earlier_is_not_up_now(body):
    assert len(weigh(Hands.none(), body(**UP, age_s=0.1), "full")) == 0


def test_a_body_seen_long_ago_says_nothing(body, upright_hand):
    hand = upright_hand((183, 78))
    assert weigh(hand, body(**PHONING, age_s=0.9), "veto").raised.tolist() == [False]
    assert weigh(hand, body(**PHONING, age_s=1.1), "veto").raised.tolist() == [True]


def test_an_arm_that_hangs_adds_nothing(body):
    assert len(weigh(Hands.none(), body(), "full")) == 0


class Always:
    def __init__(self, answer):
        self.answer = answer
        self.calls = []

    def find(self, image):
        return self.answer

    def reset(self):
        self.calls.append("reset")

    def configure(self, config):
        self.calls.append(config)


def test_both_detectors_are_asked_reset_and_configured(body, upright_hand):
    hands, bodies = Always(upright_hand((183, 78))), Always(body(**PHONING))
    opinion = SecondOpinion(hands, bodies, Config(pose_opinion="veto"))
    assert isinstance(opinion, HandDetector)
    image = CameraImage(0, "", np.zeros((480, 640, 3), np.uint8))
    assert opinion.find(image).raised.tolist() == [False]
    opinion.reset()
    lenient = Config(pose_opinion="veto", hand_head_clearance=0.1)
    opinion.configure(lenient)
    assert hands.calls == bodies.calls == ["reset", lenient]
    assert opinion.find(image).raised.tolist() == [True]


class Told(Always):
    """A hand detector that can be told where to look, and how much."""

    work = PerceptionWork(places=2)
    seen = np.full((480, 640, 3), (90, 130, 160), np.uint8)

    def expect(self, boxes_px):
        self.expected_px = boxes_px

    def set_budget(self, runs):
        self.runs = runs


def test_who_looks_piece_by_piece_is_told_where_and_how_much():
    hands = Told(Hands.none())
    opinion = SecondOpinion(hands, None, Config())
    opinion.expect(np.array([[1.0, 2.0, 3.0, 4.0]]))
    opinion.set_budget(3)
    assert hands.expected_px.tolist() == [[1.0, 2.0, 3.0, 4.0]]
    assert hands.runs == 3
    assert opinion.work.places == 2


class Guided(Told):
    """One that is told where hands are, and when to make room."""

    def __init__(self, answer):
        super().__init__(answer)
        self.suggested, self.spared = [], []

    def suggest(self, landmarks_px):
        self.suggested.append(landmarks_px)

    def spare(self, places):
        self.spared.append(places)


def watched(hands, people, images=4, **changes):
    """Play images in which something moves at once, with a watch that sees the people."""
    watch = ArmWatch(lambda bgr, window: people)
    opinion = SecondOpinion(hands, OwnerFinder(lambda bgr, window: people), Config(), watch)
    opinion.set_budget(changes.get("budget"))
    for number in range(images):
        hands.seen = np.zeros((480, 640, 3), np.uint8)
        hands.seen[50:90, 130:170] = 220 if number else 0
        opinion.find(CameraImage(number * 100_000_000, "", hands.seen))


def test_an_arm_that_went_up_is_told_to_the_hands(body):
    hands = Guided(Hands.none())
    watched(hands, body(**UP), images=3 + LOOK_PERIOD - 1)
    assert [len(items) for items in hands.suggested[:4]] == [0, 0, 1, 0]
    np.testing.assert_allclose(hands.suggested[2][0, 0], UP["right_wrist"])
    assert hands.spared == [LOOK_PLACES, LOOK_PLACES]  # before each look


def test_no_arms_are_watched_where_time_presses(body):
    hands = Guided(Hands.none())
    watched(hands, body(**UP), images=8, budget=3)
    assert not any(len(items) for items in hands.suggested)
    assert hands.spared == []


def test_the_owner_of_a_raised_hand_comes_before_other_arms(body, upright_hand):
    hands = Guided(upright_hand((400, 300)))
    watched(hands, body(), images=3)
    assert hands.spared == [LOOK_PLACES, LOOK_PLACES]  # the look at image 2 is put off


def test_a_detector_that_cannot_be_told_of_arms_is_left_alone(body):
    watched(Told(Hands.none()), body(**UP))


def refusals_of(answer):
    return [Refusal(code) for code in answer.refusal]


def test_what_the_bodies_refuse_says_why(body, upright_hand):
    at_ear = weigh(upright_hand((183, 78)), body(**PHONING), "veto")
    assert refusals_of(at_ear) == [Refusal.AT_HEAD]
    gesture = weigh(upright_hand((160, 115)), body(right_wrist=(160, 115)), "veto")
    assert refusals_of(gesture) == [Refusal.BELOW_SHOULDERS]
    in_lap = weigh(upright_hand((188, 170)), body(right_wrist=None, left_wrist=None), "veto")
    assert refusals_of(in_lap) == [Refusal.AT_REST]
    assert refusals_of(weigh(upright_hand((148, 70)), body(**UP), "veto")) == [0]


def test_a_pending_hand_keeps_its_reason_until_its_owner_vouches_or_refuses(body, upright_hand):
    brief = replace(unsure(upright_hand((148, 70))), refusal=[Refusal.TOO_BRIEF])
    assert refusals_of(weigh(brief, Bodies.none(), "veto")) == [Refusal.TOO_BRIEF]
    assert refusals_of(weigh(brief, body(**UP), "veto")) == [0]
    at_ear = replace(unsure(upright_hand((183, 78))), refusal=[Refusal.TOO_BRIEF])
    assert refusals_of(weigh(at_ear, body(**PHONING), "veto")) == [Refusal.AT_HEAD]


def test_a_hand_that_is_not_up_for_itself_keeps_that_reason_at_the_head(body, upright_hand):
    bent = replace(upright_hand((183, 78), raised=False), refusal=[Refusal.NOT_UP])
    assert refusals_of(weigh(bent, body(**PHONING), "veto")) == [Refusal.NOT_UP]


def test_a_hand_whose_owner_is_looked_for_says_so(upright_hand):
    owners = OwnerFinder(lambda bgr, window: Bodies.none())
    opinion = SecondOpinion(Always(upright_hand((148, 70))), owners, Config())
    answer = opinion.find(CameraImage(0, "", np.zeros((480, 640, 3), np.uint8)))
    assert refusals_of(answer) == [Refusal.OWNER_UNKNOWN]


def test_owners_of_a_gray_picture_s_hands_are_looked_for_in_a_tinted_one(upright_hand):
    looked = []

    def look(bgr, window):
        looked.append(bgr)
        return Bodies.none()

    opinion = SecondOpinion(Always(upright_hand((148, 70))), OwnerFinder(look), Config())
    opinion.find(CameraImage(0, "", np.full((480, 640, 3), 90, np.uint8)))
    blue, green, red = looked[0][0, 0].astype(int)
    assert red > blue > green
