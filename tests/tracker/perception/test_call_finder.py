from dataclasses import replace

import numpy as np
import pytest

from tracker.config import Config
from tracker.containers import CameraImage, Hands, PerceptionWork, Refusal
from tracker.errors import ModelFileError
from tracker.perception import HandDetector
from tracker.perception.bodies.bodies import Bodies
from tracker.perception.bodies.people_watch import PeopleWatch
from tracker.perception.call_finder import CallFinder
from tracker.perception.detector import Hints
from tracker.perception.hands.seen_picture import SeenPicture
from tracker.perception.movement import Movement

UP = {"right_elbow": (150, 105), "right_wrist": (148, 70)}
PHONING = {"right_elbow": (165, 120), "right_wrist": (183, 78)}
OVERHEAD = {"right_elbow": (165, 62), "right_wrist": (160, 22)}


class Told:
    """A hand detector that always finds the same, and notes what it is told."""

    work = PerceptionWork(places=2)
    seen = SeenPicture(np.full((480, 640, 3), (90, 130, 160), np.uint8), Movement())

    def __init__(self, answer):
        self.answer = answer
        self.calls, self.suggested = [], []

    def find(self, image, hints):
        self.hints = hints
        self.suggested.append(hints.suggested_px)
        return self.answer

    def reset(self):
        self.calls.append("reset")

    def configure(self, config):
        self.calls.append(config)


class Look:
    """Sees the same people everywhere."""

    def __init__(self, bodies):
        self.bodies, self.pictures = bodies, []

    def around(self, bgr, window):
        self.pictures.append(bgr)
        return self.bodies

    def again(self, bgr, body):
        return self.bodies

    def configure(self, config):
        pass


def image(number):
    return CameraImage(number * 100_000_000, "", np.zeros((480, 640, 3), np.uint8))


def play(hands, bodies, images=8, **parameters):
    """The hands of the last of some images."""
    watch = None if bodies is None else PeopleWatch(Look(bodies))
    finder = CallFinder(Told(hands), watch, Config().replace(**parameters))
    for number in range(images):
        answer = finder.find(image(number))
    return answer


@pytest.fixture
def open_hand(upright_hand):
    """Makes an open palm that points up, its fingers stretched."""

    def make(wrist_px, palm_px=12.0):
        hand = upright_hand(wrist_px, palm_px)
        landmarks = hand.landmarks_px.copy()
        for rows, along in (
            ((5, 9, 13, 17), 1.0),
            ((6, 10, 14, 18), 1.45),
            ((8, 12, 16, 20), 1.95),
        ):
            landmarks[0, list(rows), 1] = wrist_px[1] - palm_px * along
            landmarks[0, list(rows), 0] = wrist_px[0] + palm_px * np.array([0.3, 0.0, -0.2, -0.4])
        landmarks[0, 4] = np.array(wrist_px) + palm_px * np.array([0.8, -1.0])
        return replace(hand, landmarks_px=landmarks, raised=[False])

    return make


def fist(open_hand, wrist_px):
    hand = open_hand(wrist_px)
    landmarks = hand.landmarks_px.copy()
    landmarks[0, [8, 12, 16, 20], 1] = wrist_px[1] - 8.0
    return replace(hand, landmarks_px=landmarks)


def test_an_open_palm_beside_its_owners_head_calls(body, open_hand):
    answer = play(open_hand((148, 70)), body(**UP))
    assert answer.raised.tolist() == [True]
    np.testing.assert_allclose(answer.torso_px, [[200, 128]])
    assert answer.seated.tolist() == [0.0]


def test_a_fist_overhead_calls(body, open_hand):
    assert play(fist(open_hand, (160, 22)), body(**OVERHEAD)).raised.tolist() == [True]


def test_a_fist_at_the_ear_does_not_call_and_says_why(body, open_hand):
    answer = play(fist(open_hand, (183, 78)), body(**PHONING))
    assert answer.raised.tolist() == [False]
    assert answer.refusal.tolist() == [Refusal.AT_HEAD]


def test_hands_before_the_body_do_not_call(body, open_hand):
    together = body(right_wrist=(194, 125), left_wrist=(206, 125))
    assert play(open_hand((194, 125)), together).raised.tolist() == [False]


def test_an_arm_that_is_up_calls_where_no_hand_was_found(body):
    answer = play(Hands.none(), body(**OVERHEAD), images=14)
    assert answer.raised.tolist() == [True]
    np.testing.assert_allclose(answer.wrist_px, [[160, 22]])


def test_a_found_hand_takes_the_place_of_its_own_arm(body, open_hand):
    assert len(play(open_hand((148, 70)), body(**UP))) == 1


def test_a_place_that_always_calls_meets_a_higher_bar_unless_that_is_off(body, open_hand):
    poster = open_hand((148, 70)), body(**UP)
    assert play(*poster, images=600).refusal.tolist() == [Refusal.ALWAYS_THERE]
    assert play(*poster, images=600, place_prior=False).raised.tolist() == [True]


def test_the_work_tells_of_a_place_that_always_calls(body, open_hand):
    finder = CallFinder(Told(open_hand((148, 70))), PeopleWatch(Look(body(**UP))), Config())
    for number in range(600):
        finder.find(image(number))
    assert finder.work.place_bar > 0.0
    finder.reset()
    assert finder.work.place_bar == 0.0


def test_without_a_watch_the_hands_decide_alone(open_hand):
    answer = play(open_hand((148, 70), palm_px=30.0), None, pose_opinion="none")
    assert answer.raised.tolist() == [True]


def test_bodies_are_looked_for_in_the_picture_that_the_hands_models_saw(upright_hand):
    hands, look = Told(upright_hand((148, 70))), Look(Bodies.none())
    CallFinder(hands, PeopleWatch(look), Config()).find(image(0))
    assert look.pictures[0] is hands.seen.bgr


def test_an_arm_without_a_hand_is_suggested_to_the_hands_models(body):
    hands = Told(Hands.none())
    finder = CallFinder(hands, PeopleWatch(Look(body(**OVERHEAD))), Config())
    for number in range(12):
        finder.find(image(number))
    (landmarks_px,) = hands.suggested[-1]
    np.testing.assert_allclose(landmarks_px[0], [160, 22])


def test_it_passes_on_what_it_is_told(upright_hand):
    hands = Told(upright_hand((148, 70)))
    finder = CallFinder(hands, None, Config())
    finder.find(image(0), Hints(np.array([[1.0, 2.0, 3.0, 4.0]]), 3))
    finder.reset()
    finder.configure(Config(max_hands=2))
    assert hands.hints.expected_px.tolist() == [[1.0, 2.0, 3.0, 4.0]]
    assert (hands.hints.model_runs, hands.calls) == (3, ["reset", Config(max_hands=2)])
    assert finder.work.places == 2
    assert isinstance(finder, HandDetector)


def test_how_a_verdict_came_about_can_be_looked_at(body, open_hand):
    finder = CallFinder(Told(open_hand((148, 70))), PeopleWatch(Look(body(**UP))), Config())
    assert finder.weighed is None
    finder.find(image(0))
    assert finder.weighed.evidence.shape[0] == len(finder.weighed.belief) == 1


def test_another_rule_leaves_the_hands_their_own_verdict(open_hand, body):
    hands = Told(open_hand((148, 70)))
    finder = CallFinder(hands, PeopleWatch(Look(body(**UP))), Config())
    finder.configure(Config(raise_rule="palm"))
    assert finder.find(image(0)) is hands.answer
    finder.configure(Config())
    assert finder.find(image(1)) is not hands.answer


def test_bodies_are_opened_when_the_evidence_is_asked_for(open_hand, body):
    opened = []

    def open_watch(config):
        opened.append(config.raise_rule)
        return PeopleWatch(Look(body(**UP)))

    hands, palm = Told(open_hand((148, 70))), Config(raise_rule="palm")
    finder = CallFinder(hands, None, palm, open_watch)
    finder.find(image(0))
    finder.configure(palm.replace(palm_raised_threshold=2.0))
    assert opened == []
    for _ in range(2):
        finder.configure(Config())
    assert opened == ["evidence"]
    finder.configure(Config(inference_threads=1))  # the hand models are opened again as well
    assert opened == ["evidence"] * 2
    for number in range(1, 9):
        answer = finder.find(image(number))
    assert answer.raised.tolist() == [True]
    assert len(finder.weighed.bodies) == 1


def test_a_rule_whose_models_cannot_be_opened_changes_nothing(open_hand):
    def fail(config):
        raise ModelFileError("absent")

    hands, palm = Told(open_hand((148, 70))), Config(raise_rule="palm")
    finder = CallFinder(hands, None, palm, fail)
    with pytest.raises(ModelFileError):
        finder.configure(Config())
    assert hands.calls == []
    assert finder.find(image(0)) is hands.answer
