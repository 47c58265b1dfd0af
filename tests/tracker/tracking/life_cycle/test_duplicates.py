"""Is one person tracked twice?"""

import numpy as np
import pytest

from tracker.tracking.life_cycle.duplicates import SILENT_S, merge_duplicates
from tracker.tracking.people import (
    BORN_NS,
    CALLED_NS,
    CONFIRMED,
    DETECTIONS,
    HAND,
    ID,
    MISSING_S,
    SEEN_NS,
)

OLD, YOUNG, BYSTANDER = 4, 9, -2
SECOND_NS = 10**9


@pytest.fixture
def merge(people_of):
    """Joins an older track that has been silent for a second with a younger one that is seen.

    Gives the people, and which rows are left.
    """

    def merged(apart_m=0.3, together_s=0.0, ids=(OLD, YOUNG), known=2, silent_s=1.0):
        mean = np.array([[2.0, 0.0, 0.0, 0.0], [2.0, apart_m, 0.0, 0.0]])
        people, keep = people_of(mean, np.eye(4), ids=ids), np.ones(2, dtype=bool)
        people.spans[MISSING_S] = [silent_s, 0.0]
        people.counts[SEEN_NS] = round(together_s * SECOND_NS) + np.array([0, SECOND_NS])
        people.counts[DETECTIONS], people.counts[HAND] = [6, 2], [-1, 3]
        people.counts[CALLED_NS] = people.counts[SEEN_NS]
        people.counts[BORN_NS, 0] = -7
        people.flags[CONFIRMED] = [True, False]
        merge_duplicates(people, people.mean[:, :known].copy(), np.array([0.0, 0.9]), keep, 0.45)
        return people, keep

    return merged


@pytest.fixture
def left(merge):
    """Identities of those who are left."""

    def ids(**changes):
        people, keep = merge(**changes)
        return people.counts[ID, keep].tolist()

    return ids


@pytest.mark.parametrize("known", [1, 2], ids=["has just come", "was there before"])
def test_the_older_identity_goes_on_in_the_younger_one_s_place(merge, known):
    people, keep = merge(known=known)
    assert keep.tolist() == [True, False]
    assert people.counts[ID, 0] == OLD
    assert people.mean[0, 0, 1] == 0.3


def test_what_a_customer_has_been_counts_on(merge):
    people, _ = merge()
    assert people.counts[[DETECTIONS, HAND, BORN_NS], 0].tolist() == [6, 3, -7]
    assert people.counts[[SEEN_NS, CALLED_NS], 0].tolist() == [SECOND_NS, SECOND_NS]
    assert people.spans[MISSING_S, 0] == 0.0
    assert people.flags[CONFIRMED, 0]


def test_who_was_followed_beside_the_silent_one_keeps_their_own_identity(merge):
    people, keep = merge(together_s=5.0)
    assert people.counts[ID, keep].tolist() == [YOUNG]
    assert people.mean[0, 1, 1] == 0.3


def test_of_two_customers_the_older_identity_is_kept_whichever_row_it_has(left):
    assert left(ids=(YOUNG, OLD)) == [OLD]


def test_a_customer_who_sets_off_is_followed_for_a_moment_beside_themselves(left):
    assert left(together_s=0.3) == [OLD]


@pytest.mark.parametrize(
    ("together_s", "expected"), [(0.3, [OLD]), (5.0, [OLD, BYSTANDER])], ids=["new", "known"]
)
def test_a_bystander_who_was_there_before_is_somebody_else(left, together_s, expected):
    assert left(together_s=together_s, ids=(OLD, BYSTANDER)) == expected


def test_a_silent_bystander_is_nobody_s_duplicate(left):
    assert left(ids=(BYSTANDER, YOUNG)) == [BYSTANDER, YOUNG]


def test_who_stands_apart_is_somebody_else(left):
    assert left(apart_m=0.6) == [OLD, YOUNG]


def test_who_has_been_silent_for_a_moment_alone_is_left_alone(left):
    assert left(silent_s=0.9 * SILENT_S) == [OLD, YOUNG]


@pytest.mark.parametrize(
    ("velocity_mps", "passed_s", "expected"),
    [
        ((1.0, 0.2), 2.0, [OLD]),
        ((0.0, 0.0), 2.0, [OLD, BYSTANDER]),
        ((1.0, 0.2), 4.0, [OLD, BYSTANDER]),
    ],
    ids=["walks away from there", "stands", "too long ago"],
)
def test_who_comes_walking_from_where_a_customer_was_is_that_customer(
    people_of, velocity_mps, passed_s, expected
):
    place = np.array([3.0, 1.0]) + np.array([1.0, 0.2]) * passed_s
    mean = np.array([[3.0, 1.0, 0.0, 0.0], [*place, *velocity_mps]])
    people, keep = people_of(mean, np.eye(4), ids=(OLD, BYSTANDER)), np.ones(2, dtype=bool)
    people.spans[MISSING_S, 0] = passed_s
    people.counts[BORN_NS, 1] = round((passed_s - 0.5) * SECOND_NS)
    people.counts[SEEN_NS, 1] = round(passed_s * SECOND_NS)
    merge_duplicates(people, people.mean.copy(), np.array([0.0, 1.0]), keep, 0.45)
    assert people.counts[ID, keep].tolist() == expected


@pytest.mark.parametrize(
    ("id", "missing_s", "born_s"),
    [(YOUNG, 2.0, -5.0), (BYSTANDER, 0.1, 1.5), (BYSTANDER, 2.0, -5.0)],
    ids=["a customer of before", "the sensors had turned away", "was there before"],
)
def test_who_is_known_to_come_from_elsewhere_is_somebody_else(people_of, id, missing_s, born_s):
    mean = np.array([[3.0, 1.0, 0.0, 0.0], [5.0, 1.4, 1.0, 0.2]])
    people, keep = people_of(mean, np.eye(4), ids=(OLD, id)), np.ones(2, dtype=bool)
    people.spans[MISSING_S, 0] = missing_s
    people.counts[BORN_NS, 1] = round(born_s * SECOND_NS)
    people.counts[SEEN_NS, 1] = 2 * SECOND_NS
    merge_duplicates(people, people.mean.copy(), np.array([0.0, 1.0]), keep, 0.45)
    assert people.counts[ID, keep].tolist() == [OLD, id]


def test_the_nearest_of_those_who_are_seen_is_the_duplicate(people_of):
    mean = np.array([[0.0, 0, 0, 0], [0.4, 0, 0, 0], [0.2, 0, 0, 0]])
    people, keep = people_of(mean, np.eye(4), ids=[1, 2, 3]), np.ones(3, dtype=bool)
    people.spans[MISSING_S, 0] = 1.0
    merge_duplicates(people, people.mean.copy(), np.array([0.0, 1.0, 1.0]), keep, 0.45)
    assert keep.tolist() == [True, True, False]
    assert people.mean[0, 0, 0] == 0.2
