import numpy as np
import pytest

from tracker.containers import Hands
from tracker.perception.verdict.memory import HandMemory

PERIOD_NS = 100_000_000


def swing(upright_hand, columns):
    memory = HandMemory()
    for number, column in enumerate(columns):
        (item,) = memory.recognize(number * PERIOD_NS, upright_hand((column, 100.0)))
    return item.swing()


def test_where_hand_and_forearm_take_turns_nothing_swings(upright_hand):
    columns = [100.0, 112.0] * 8
    assert swing(upright_hand, columns) == 1.0
    memory = HandMemory()
    for number, column in enumerate(columns):
        found = np.array([number % 2 == 0])
        (item,) = memory.recognize(number * PERIOD_NS, upright_hand((column, 100.0)), found)
    assert item.swing() == 0.0


def test_a_hand_is_the_same_where_it_was_a_moment_ago(upright_hand):
    memory = HandMemory()
    (first,) = memory.recognize(0, upright_hand((100, 100)))
    first.log_odds = 2.0
    (again,) = memory.recognize(PERIOD_NS, upright_hand((115, 100)))
    (other,) = memory.recognize(2 * PERIOD_NS, upright_hand((300, 100)))
    assert again.log_odds == 2.0
    assert np.isnan(other.log_odds)


def test_two_hands_keep_their_own_memory_whichever_comes_first(upright_hand):
    memory = HandMemory()
    left, right = upright_hand((100, 100)), upright_hand((150, 100))
    for item, odds in zip(
        memory.recognize(0, Hands.concatenate(left, right)), (1, 2), strict=True
    ):
        item.log_odds = float(odds)
    again = memory.recognize(PERIOD_NS, Hands.concatenate(right, left))
    assert [item.log_odds for item in again] == [2.0, 1.0]


@pytest.mark.parametrize(("images", "is_known"), [(9, True), (11, False)])
def test_a_hand_is_remembered_for_a_second(upright_hand, images, is_known):
    memory = HandMemory()
    memory.recognize(0, upright_hand((100, 100)))[0].log_odds = 1.0
    memory.recognize(PERIOD_NS, Hands.none())
    (item,) = memory.recognize(images * PERIOD_NS, upright_hand((100, 100)))
    assert np.isfinite(item.log_odds) == is_known


def test_of_two_remembered_hands_it_is_the_one_that_was_seen_last(upright_hand):
    memory = HandMemory()
    twins = Hands.concatenate(upright_hand((100, 100)), upright_hand((112, 100)))
    first, second = memory.recognize(0, twins)
    assert memory.recognize(PERIOD_NS, upright_hand((108, 100))) == [second]
    for number in range(2, 5):
        (item,) = memory.recognize(number * PERIOD_NS, upright_hand((101, 100)))
    assert item is second is not first


def test_a_wave_is_told_from_a_still_hand_and_from_one_that_moves_on(upright_hand):
    to_and_fro = [100, 115, 100, 85, 100, 115, 100, 85]
    assert swing(upright_hand, to_and_fro) == 1.0
    assert swing(upright_hand, [100, 101, 99, 100, 101, 99]) == 0.0
    assert swing(upright_hand, [100, 110, 120, 130, 140]) == 0.0


def test_a_hand_that_is_weighed_remembers(upright_hand):
    memory = HandMemory()
    (item,) = memory.recognize(0, upright_hand((100, 100)))
    first = item.weigh(0, 3.0)
    (again,) = memory.recognize(PERIOD_NS, upright_hand((100, 100)))
    assert again.weigh(PERIOD_NS, 3.0) > first


def test_reset_forgets(upright_hand):
    memory = HandMemory()
    memory.recognize(0, upright_hand((100, 100)))[0].log_odds = 1.0
    memory.reset()
    (item,) = memory.recognize(PERIOD_NS, upright_hand((100, 100)))
    assert np.isnan(item.log_odds)
