import itertools

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

from tracker.evaluation.metrics.matching import distances, match_best, match_faithfully


def best_sum(gain):
    """The highest sum of gains, by trying every way to pair."""
    rows, columns = gain.shape
    if rows > columns:
        return best_sum(gain.T)
    ways = itertools.permutations(range(columns), rows)
    return max(sum(max(gain[row, to], 0.0) for row, to in enumerate(way)) for way in ways)


@pytest.mark.parametrize("shape", [(1, 4), (4, 1), (3, 3), (4, 3), (3, 4)], ids=str)
def test_no_way_to_pair_is_worth_more(shape):
    gain = np.random.default_rng(3).uniform(-1.0, 1.0, (200, *shape))
    pairs = match_best(gain)
    assert (pairs.sum(axis=1) <= 1).all()
    assert (pairs.sum(axis=2) <= 1).all()
    assert (gain[pairs] > 0.0).all()
    found = np.where(pairs, gain, 0.0).sum(axis=(1, 2))
    np.testing.assert_allclose(found, [best_sum(item) for item in gain])


@pytest.mark.parametrize("shape", [(0, 3), (3, 0), (0, 0)], ids=str)
def test_nobody_is_paired_with_nothing(shape):
    assert match_best(np.ones((5, *shape))).shape == (5, *shape)


def test_places_where_nobody_is_are_infinitely_far():
    tracks, people = np.zeros((2, 1, 2)), np.zeros((2, 2, 2))
    people[1, 0] = np.nan
    people[1, 1] = [3.0, 4.0]
    np.testing.assert_array_equal(distances(tracks, people), [[[0.0, 0.0]], [[np.inf, 5.0]]])


def near(apart):
    return 1.0 - np.asarray(apart) ** 2


def test_a_pair_stays_while_near_even_where_another_is_nearer():
    ids = np.array([[5, 6], [5, 6]])
    pairs = match_faithfully(ids, near([[[0.0, 3.0], [3.0, 0.0]], [[0.6, 0.1], [0.1, 0.6]]]))
    np.testing.assert_array_equal(pairs[1], np.eye(2))


def test_a_pair_stays_where_its_track_stands_in_another_column():
    ids = np.array([[5, 6], [6, 5]])
    pairs = match_faithfully(ids, near([[[0.0, 3.0], [3.0, 0.0]], [[0.1, 0.6], [0.6, 0.1]]]))
    np.testing.assert_array_equal(pairs[1], 1.0 - np.eye(2))


def test_a_pair_that_parted_is_paired_anew():
    pairs = match_faithfully(np.array([[5, 0], [5, 6]]), near([[[0.0], [9.0]], [[4.0], [0.2]]]))
    np.testing.assert_array_equal(pairs[:, :, 0], [[1, 0], [0, 1]])


def test_who_comes_near_while_free_is_paired():
    pairs = match_faithfully(np.full((3, 1), 5), near([[[2.0, 2.0]], [[0.9, 2.0]], [[0.9, 0.1]]]))
    np.testing.assert_array_equal(pairs[:, 0], [[0, 0], [1, 0], [1, 0]])


def test_nobody_is_remembered_over_a_frame_without_a_pair():
    pairs = match_faithfully(np.full((3, 1), 5), near([[[0.5, 0.9]], [[2.0, 2.0]], [[0.9, 0.5]]]))
    np.testing.assert_array_equal(pairs[:, 0], [[1, 0], [0, 0], [0, 1]])


def frame_by_frame(ids, gain):
    """The CLEAR MOT metrics as their paper tells them, with a memory of the last frame."""
    last, found = {}, np.zeros(gain.shape, dtype=bool)
    for frame, worth in enumerate(np.where(gain > 0.0, gain, 0.0)):
        for person, track in last.items():
            for row in np.flatnonzero(ids[frame] == track):
                if worth[row, person] > 0.0:
                    kept = worth[row, person]
                    worth[row, :] = worth[:, person] = 0.0
                    worth[row, person] = kept
        row, person = linear_sum_assignment(worth, maximize=True)
        paired = worth[row, person] > 0.0
        row, person = row[paired], person[paired]
        found[frame, row, person] = True
        last = dict(zip(person.tolist(), ids[frame, row].tolist(), strict=True))
    return found


def test_jumping_from_change_to_change_finds_what_every_frame_by_itself_would():
    rng = np.random.default_rng(8)
    for _ in range(30):
        tracks, people = rng.uniform(0.0, 2.0, (2, 4, 2))
        ids, far = np.arange(1, 5), []
        all_ids = []
        for _ in range(80):
            tracks, people = (xy + rng.normal(0.0, 0.05, xy.shape) for xy in (tracks, people))
            far.append(np.linalg.norm(tracks[:, None] - people[None], axis=-1))
            if rng.random() < 0.05:
                ids = rng.permutation(ids)
            if rng.random() < 0.1:
                ids = np.where(rng.random(4) < 0.3, ids + 10, ids)
            all_ids.append(ids)
        gain = near(far)
        found = match_faithfully(np.array(all_ids), gain)
        np.testing.assert_array_equal(found, frame_by_frame(np.array(all_ids), gain))
