from dataclasses import dataclass

import numpy as np
import pytest

from tracker.perception.rows import Rows, kept


@dataclass(frozen=True, slots=True, eq=False)
class Squares(Rows):
    side: np.ndarray

    @kept
    def area(self):
        """Of each."""
        calls.append(len(self))
        return self.side**2


calls = []


@pytest.fixture(autouse=True)
def forget_calls():
    calls.clear()


def test_what_is_kept_is_computed_once_and_cannot_be_changed():
    squares = Squares(np.array([1.0, 2.0]))
    assert squares.area.tolist() == [1.0, 4.0]
    assert squares.area is squares.area
    assert calls == [2]
    with pytest.raises(ValueError, match="read-only"):
        squares.area[0] = 9.0


def test_other_rows_have_their_own():
    squares = Squares(np.array([1.0, 2.0]))
    assert squares[[1]].area.tolist() == [4.0]
    assert Squares.concatenate(squares, squares).area.tolist() == [1.0, 4.0, 1.0, 4.0]
    assert squares.area.tolist() == [1.0, 4.0]
