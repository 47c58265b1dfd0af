from dataclasses import replace

import numpy as np
import pytest

from tracker.containers import Hands
from tracker.perception.bodies import Bodies
from tracker.perception.head_memory import HeadMemory

PERIOD_NS = 100_000_000
CLEARANCE = 0.4  # of shoulders that are 40 px wide: 16 px
#: The fingers' roots are 10 px above the wrist, the ear at (190, 58): 8.6, 14.3, 17.5 and 22.4 px
#: away.
AT_EAR, HARDLY_AT_EAR, HARDLY_CLEAR, CLEAR = (183, 73), (177, 74), (174, 75), (169, 75)


@pytest.fixture
def judge(body, upright_hand):
    """Asks a memory about a hand at a wrist, in one image."""

    def ask(memory, wrist, number=0):
        hands, bodies = upright_hand(wrist, palm_px=10.0), body(right_wrist=wrist)
        stamp_ns = number * PERIOD_NS
        (answer,) = memory.judge(stamp_ns, hands, bodies, np.array([0]), CLEARANCE)
        return bool(answer)

    return ask


@pytest.mark.parametrize(
    ("wrist", "at_head"),
    [(AT_EAR, True), (HARDLY_AT_EAR, True), (HARDLY_CLEAR, False), (CLEAR, False)],
)
def test_a_new_hand_is_judged_by_the_clearance_alone(judge, wrist, at_head):
    assert judge(HeadMemory(), wrist) == at_head


@pytest.mark.parametrize(("wrist", "at_head"), [(HARDLY_CLEAR, True), (CLEAR, False)])
def test_a_hand_that_was_at_the_head_must_get_well_clear_of_it(judge, wrist, at_head):
    memory = HeadMemory()
    judge(memory, AT_EAR, 0)
    assert judge(memory, wrist, 1) == at_head


def test_a_hand_raised_close_to_the_head_is_clear_as_soon_as_it_seems_so(judge):
    memory = HeadMemory()
    assert judge(memory, HARDLY_AT_EAR, 0)
    assert not judge(memory, HARDLY_CLEAR, 1)


def test_so_it_is_for_a_second(judge):
    answers = []
    for later in (10, 11):
        memory = HeadMemory()
        judge(memory, AT_EAR, 0)
        answers.append(judge(memory, HARDLY_CLEAR, later))
    assert answers == [True, False]


def test_another_hand_has_not_been_at_the_head(judge):
    memory = HeadMemory()
    judge(memory, (217, 73), 0)  # at the other ear
    assert not judge(memory, HARDLY_CLEAR, 1)


def test_a_hand_stays_at_the_head_while_nobody_knows_whose_it_is(judge, upright_hand):
    memory, unknown = HeadMemory(), np.array([-1])
    judge(memory, AT_EAR, 0)
    answers = [
        memory.judge(
            number * PERIOD_NS, upright_hand(AT_EAR), Bodies.none(), unknown, CLEARANCE
        ).item()
        for number in range(1, 30)
    ]
    assert all(answers)
    assert not judge(memory, CLEAR, 30)  # its owner has been seen


@pytest.mark.parametrize(("later", "at_head"), [(10, True), (11, False)])
def test_a_hand_at_a_head_is_not_clear_of_it_by_the_word_of_somebody_who_seems_smaller(
    judge, body, upright_hand, later, at_head
):
    memory, hand = HeadMemory(), upright_hand(AT_EAR)
    judge(memory, AT_EAR, 0)
    small = body(right_wrist=None)
    beside = np.array([148.5, 44.0])  # the hand is two of its shoulders away from its head
    small = replace(small, points_px=small.points_px / 4.0 + beside)
    answer = memory.judge(later * PERIOD_NS, hand, small, np.array([0]), CLEARANCE)
    assert HeadMemory().judge(0, hand, small, np.array([0]), CLEARANCE).tolist() == [False]
    assert answer.tolist() == [at_head]


def test_a_hand_at_the_head_of_a_body_whose_wrist_is_lost_is_at_it(body, upright_hand):
    somebody, hand = body(right_wrist=None), upright_hand(AT_EAR)
    assert HeadMemory().judge(0, hand, somebody, np.array([-1]), CLEARANCE).tolist() == [True]


@pytest.mark.parametrize("stamps", [(5, 4), (0, 1)], ids=["time jumps back", "reset"])
def test_hands_are_forgotten_with_the_images(judge, stamps):
    memory = HeadMemory()
    judge(memory, AT_EAR, stamps[0])
    if stamps[1] > stamps[0]:
        memory.reset()
    assert not judge(memory, HARDLY_CLEAR, stamps[1])


def test_no_hands_are_no_trouble(judge):
    memory = HeadMemory()
    nobody = np.zeros(0, dtype=np.int64)
    assert memory.judge(0, Hands.none(), Bodies.none(), nobody, CLEARANCE).tolist() == []
    assert judge(memory, AT_EAR, 1)
