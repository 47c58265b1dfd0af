from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated

import numpy as np
import pytest

from tracker.containers.arrays import BoolArray, FloatArray, IntArray
from tracker.containers.rows import Column, Rows
from tracker.errors import ShapeError


@dataclass(frozen=True, eq=False)
class Places(Rows):
    stamp_ns: int
    xy_m: Annotated[FloatArray, Column((2,))]
    number: IntArray
    known: Annotated[BoolArray, Column(missing=False)] = None  # type: ignore[assignment]
    corners_m: Annotated[FloatArray, Column((-1, 2), missing=None)] = None  # type: ignore[assignment]


def places(count: int, stamp_ns: int = 7) -> Places:
    corners_m = np.zeros((count, 3, 2))
    return Places(stamp_ns, np.ones((count, 2)), np.arange(count), None, corners_m)


def test_the_annotations_say_the_type_and_shape_of_each_array():
    with pytest.raises(ShapeError, match=r"Places disagree in shape: xy_m \(2, 3\)"):
        Places(0, np.zeros((2, 3)), np.zeros(2), None, np.zeros((2, 1, 2)))
    assert places(2).number.dtype == np.int64


def test_a_row_of_any_length_must_still_have_as_many_dimensions():
    assert places(2).corners_m.shape == (2, 3, 2)
    with pytest.raises(ShapeError, match="corners_m"):
        Places(0, np.zeros((2, 2)), np.zeros(2), None, np.zeros((2, 2)))


def test_what_is_left_out_is_filled_where_the_class_says_by_what():
    assert places(3).known.tolist() == [False] * 3


def test_a_part_of_the_rows_keeps_what_holds_for_all_and_cannot_be_written():
    part = places(4)[[3, 1]]
    assert (part.stamp_ns, part.number.tolist()) == (7, [3, 1])
    with pytest.raises(ValueError, match="read-only"):
        part.number[0] = 9


def test_joined_batches_keep_what_holds_for_all_rows_of_the_first():
    joined = Places.concatenate(places(1, 5), places(2, 6))
    assert (joined.stamp_ns, joined.number.tolist()) == (5, [0, 0, 1])


def test_a_batch_of_no_rows_has_arrays_of_the_right_shape():
    nothing = Places.none(9)
    assert (len(nothing), nothing.stamp_ns, nothing.xy_m.shape) == (0, 9, (0, 2))
    assert nothing.known.dtype == np.bool_


@dataclass(frozen=True, eq=False)
class Squares(Rows):
    side: FloatArray

    @cached_property
    def area(self):
        return self.side**2


def test_what_a_batch_has_computed_once_is_not_taken_over_by_other_rows():
    squares = Squares(np.array([1.0, 2.0]))
    assert squares.area is squares.area
    assert squares[[1]].area.tolist() == [4.0]
    assert Squares.concatenate(squares, squares[[1]]).area.tolist() == [1.0, 4.0, 4.0]
