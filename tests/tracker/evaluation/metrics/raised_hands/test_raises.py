from tracker.evaluation.metrics.raised_hands.episode_report import (
    EpisodeReport,
    EpisodeRow,
    InventedRow,
)
from tracker.evaluation.metrics.raised_hands.raises import count_raises


def episode(person, second, identities):
    """An episode of two seconds, reported after half of one if anybody reported it."""
    start, reported = second * 10**9, second * 10**9 + 5 * 10**8
    return EpisodeRow(
        person, start, start + 2 * 10**9, (0.0, 0.0), 20, reported if identities else None,
        3 if identities else None, None, identities,
    )  # fmt: skip


def counted(*episodes, invented=()):
    return count_raises(EpisodeReport(0, episodes, invented, 0, {}, 0, None, 100, 0))


def test_the_same_identity_after_a_pause_is_counted():
    raises = counted(episode(0, 1, (4,)), episode(0, 9, (4,)), episode(0, 20, (5,)))
    assert (raises.again, raises.same, raises.wrong) == (2, 1, 0)


def test_a_neighbor_s_identity_is_wrong_and_a_new_one_is_not():
    raises = counted(
        episode(0, 1, (4,)), episode(1, 2, (7,)), episode(0, 9, (7,)), episode(1, 10, (8,))
    )
    assert (raises.again, raises.same, raises.wrong) == (2, 0, 1)


def test_an_older_identity_of_one_s_own_is_neither_the_same_nor_somebody_else_s():
    raises = counted(episode(0, 1, (4, 5)), episode(0, 9, (4,)))
    assert (raises.again, raises.same, raises.wrong) == (1, 0, 0)


def test_missed_and_false_raises_and_delays():
    false = InventedRow(9, 0, 10**9, (0.0, 0.0), None)
    raises = counted(episode(0, 1, (4,)), episode(1, 2, ()), invented=(false,))
    assert (raises.hands, raises.missed, raises.false) == (2, 1, 1)
    assert raises.delays_s == (0.5,)
