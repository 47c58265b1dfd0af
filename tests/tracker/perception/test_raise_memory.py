import numpy as np

from tracker.config import Config
from tracker.containers import Refusal
from tracker.perception.landmarks import Landmarks
from tracker.perception.raise_memory import RaiseMemory

SIZE = (640, 480)
PERIOD_NS = 100_000_000
CONFIG = Config(small_hand_patience_s=0.3)


def hand(rise_palms, palm_px=60.0, score=0.95, aside_palms=0.0):
    """One hand, its middle finger's tip so many palms above and beside the wrist."""
    points = np.zeros((1, 21, 2))
    points[0, 9, 1] = -palm_px
    points[0, 12] = aside_palms * palm_px, -rise_palms * palm_px
    return Landmarks(points + 200.0, np.array([score]), np.array([0.5]))


def verdicts(hands, config=CONFIG, rows=None, memory=None):
    """Of one followed hand, image after image."""
    memory = memory or RaiseMemory()
    rows = rows or [-1] + [0] * (len(hands) - 1)
    return [
        bool(memory.judge(frame * PERIOD_NS, one, np.array([row]), SIZE, config)[0][0])
        for frame, (one, row) in enumerate(zip(hands, rows, strict=True))
    ]


def test_a_hand_goes_up_at_one_threshold_and_down_at_a_lower_one():
    rises = [1.0, 1.2, 1.0, 0.95, 0.85, 1.0, 1.2]
    assert verdicts([hand(rise) for rise in rises]) == [
        False,
        True,
        True,
        True,
        False,
        False,
        True,
    ]


def test_a_hand_that_leans_does_not_go_up_but_stays_up_until_it_leans_farther():
    upright, leaning, falling = hand(1.8), hand(1.5, aside_palms=1.3), hand(1.2, aside_palms=1.6)
    # 41 and 53 degrees.
    assert verdicts([leaning, upright, leaning, falling]) == [False, True, True, False]


def test_an_unsure_hand_does_not_go_up_but_stays_up():
    scores = [0.7, 0.85, 0.6]
    assert verdicts([hand(1.8, score=score) for score in scores]) == [False, True, True]


def test_a_small_hand_counts_once_it_has_been_up_for_a_while():
    small = [hand(1.8, palm_px=10.0)] * 6
    assert verdicts(small) == [False, False, False, True, True, True]


def pending(hands):
    """Of one followed hand, image after image."""
    memory = RaiseMemory()
    rows = [-1] + [0] * (len(hands) - 1)
    return [
        bool(memory.judge(frame * PERIOD_NS, one, np.array([row]), SIZE, CONFIG)[2][0])
        for frame, (one, row) in enumerate(zip(hands, rows, strict=True))
    ]


def test_an_unsure_hand_that_is_up_is_pending_until_it_goes_down():
    unsure = hand(1.8, score=0.6)
    assert pending([unsure, hand(1.0, score=0.6), hand(0.8, score=0.6)]) == [True, True, False]
    assert pending([hand(1.0, score=0.6), hand(1.8)]) == [False, False]


def test_a_small_hand_is_pending_until_it_counts():
    assert pending([hand(1.8, palm_px=10.0)] * 5) == [True, True, True, False, False]


def test_a_small_hand_that_goes_down_begins_anew():
    up, down = hand(1.8, palm_px=10.0), hand(0.5, palm_px=10.0)
    assert verdicts([up, up, down, up, up, up, up])[3:] == [False, False, False, True]


def test_a_hand_that_is_newly_found_remembers_nothing():
    between = hand(1.0)
    assert verdicts([hand(1.8), between, between], rows=[-1, 0, -1]) == [True, True, False]


def test_memories_follow_hands_that_change_rows():
    memory = RaiseMemory()
    up, between = hand(1.8), hand(1.0)
    both = Landmarks.concatenate(between, up)
    memory.judge(0, both, np.array([-1, -1]), SIZE, CONFIG)
    again = Landmarks.concatenate(between, between)
    raised = memory.judge(PERIOD_NS, again, np.array([1, 0]), SIZE, CONFIG).raised
    assert raised.tolist() == [True, False]


def test_reset_forgets():
    memory = RaiseMemory()
    memory.judge(0, hand(1.8), np.array([-1]), SIZE, CONFIG)
    memory.reset()
    assert verdicts([hand(1.0)], memory=memory) == [False]


def test_the_specification_s_rule_has_neither_memory_nor_patience():
    config = Config(raise_rule="image", hand_raised_threshold=0.1, hand_span_threshold=0.0)
    spread = hand(1.8)
    spread.points_px[0, 20, 0] += 10.0
    assert verdicts([spread, spread], config) == [True, True]
    assert verdicts([hand(1.0), spread, hand(1.0)], config) == [False, True, False]


def reasons(hands):
    """Of one followed hand, image after image."""
    memory = RaiseMemory()
    rows = [-1] + [0] * (len(hands) - 1)
    return [
        Refusal(memory.judge(frame * PERIOD_NS, one, np.array([row]), SIZE, CONFIG).refusal[0])
        for frame, (one, row) in enumerate(zip(hands, rows, strict=True))
    ]


def test_a_hand_that_does_not_count_says_why():
    assert reasons([hand(0.4)]) == [Refusal.NOT_UP]
    assert reasons([hand(1.5, aside_palms=1.3)]) == [Refusal.LEANS]
    assert reasons([hand(1.8, score=0.7)]) == [Refusal.UNSURE]
    assert reasons([hand(1.8, palm_px=10.0)] * 4) == [*[Refusal.TOO_BRIEF] * 3, 0]


def test_a_hand_that_comes_down_says_why():
    assert reasons([hand(1.8), hand(0.7)]) == [0, Refusal.NOT_UP]
    assert reasons([hand(1.8), hand(1.2, aside_palms=1.6)]) == [0, Refusal.LEANS]
