import numpy as np

from tracker.evaluation.metrics.matching import Matcher


def test_a_pair_stays_while_near_even_where_another_is_nearer():
    matcher = Matcher(cutoff_m=1.0)
    ids, people = np.array([5, 6]), np.array([0, 1])
    matcher.match(ids, np.array([[0.0, 0.0], [3.0, 0.0]]), people, np.array([[0, 0], [3, 0]]))
    rows, columns = matcher.match(
        ids, np.array([[0.6, 0.0], [0.1, 0.0]]), people, np.array([[0.0, 0.0], [0.7, 0.0]])
    )
    assert dict(zip(rows.tolist(), columns.tolist(), strict=True)) == {0: 0, 1: 1}


def test_a_pair_that_parted_is_paired_anew():
    matcher = Matcher(cutoff_m=1.0)
    person = np.array([0])
    matcher.match(np.array([5]), np.zeros((1, 2)), person, np.zeros((1, 2)))
    tracks = np.array([[4.0, 0.0], [0.2, 0.0]])
    rows, columns = matcher.match(np.array([5, 6]), tracks, person, np.zeros((1, 2)))
    assert (rows.tolist(), columns.tolist()) == ([1], [0])


def test_no_far_pair_is_forced_on_anybody():
    rows, columns = Matcher(cutoff_m=1.0).match(
        np.array([1]), np.array([[2.0, 0.0]]), np.array([0]), np.zeros((1, 2))
    )
    assert len(rows) == len(columns) == 0
