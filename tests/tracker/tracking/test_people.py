"""What is remembered of everybody, row by row."""

import numpy as np
import pytest

from tracker.tracking.people import copy_person, kept, room_for, with_room


@pytest.fixture
def people():
    """Three people in two modes; all numbers differ."""
    room = room_for(2, 3, 4)
    rng = np.random.default_rng(1)
    for array in room:
        array[:] = rng.integers(0, 100, array.shape)
    room.recent[:] = [[True, False, False, False], [False] * 4, [True] * 4]
    return room


def rows_of(people, rows):
    """Everything about some of them, with the people on the first axis."""
    by_mode = [np.moveaxis(each, 1, 0)[rows] for each in people[:3]]
    by_item = [each.T[rows] for each in (people.spans, people.counts, people.flags)]
    return [*by_mode, *by_item, people.recent[rows]]


def assert_same(one, other):
    for mine, theirs in zip(one, other, strict=True):
        np.testing.assert_array_equal(mine, theirs)


def test_there_is_room_for_so_many_people_modes_and_images():
    room = room_for(2, 3, 4)
    assert [each.shape for each in room] == [
        *((2, 3), (2, 3, 4), (2, 3, 4, 4)),
        *((7, 3), (10, 3), (2, 3), (3, 4)),
    ]
    assert [each.dtype.name for each in room] == [*["float64"] * 4, "int64", "bool", "bool"]


def test_whoever_is_copied_is_the_same_in_the_other_row(people):
    room = room_for(2, 3, 4)
    copy_person(people, 2, room, 0)
    assert_same(rows_of(room, [0]), rows_of(people, [2]))


def test_with_room_behind_them_people_are_the_same_and_their_arrays_their_own(people):
    room = with_room(people, 2)
    assert room.weight.shape == (2, 5)
    assert_same(rows_of(room, [0, 1, 2]), rows_of(people, [0, 1, 2]))
    for mine, theirs in zip(with_room(people, 0), people, strict=True):
        assert not np.shares_memory(mine, theirs)


def test_those_who_are_kept_stay_in_order(people):
    keep = np.array([True, False, True])
    assert_same(rows_of(kept(people, keep, 2), [0, 1]), rows_of(people, [0, 2]))
    assert kept(people, np.zeros(3, dtype=bool), 0).weight.shape == (2, 0)
