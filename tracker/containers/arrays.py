"""Which types do arrays have, and how are they made read-only?"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracker.errors import ClockError, ShapeError

FloatArray: TypeAlias = NDArray[np.float64]
IntArray: TypeAlias = NDArray[np.int64]
BoolArray: TypeAlias = NDArray[np.bool_]
ImageArray: TypeAlias = NDArray[np.uint8]
NUMBERS, COUNTS, FLAGS = np.dtype(np.float64), np.dtype(np.int64), np.dtype(np.bool_)


def check_stamp(stamp_ns: int) -> None:
    """Refuse an invalid stamp.

    Raises:
        ClockError: Negative, beyond 63 bits, or not an integer.
    """
    if not isinstance(stamp_ns, (int, np.integer)) or not 0 <= stamp_ns < 2**63:
        raise ClockError(
            f"A stamp of {stamp_ns!r} ns came; stamps are integer nanoseconds from 0 to 2**63 - 1."
        )


def frozen(value: ArrayLike, dtype: np.dtype[Any] = NUMBERS) -> NDArray[Any]:
    """The same numbers, read-only; whoever holds the array may go on writing to it."""
    if type(value) is np.ndarray and value.dtype == dtype and not value.flags.writeable:
        return value
    view: NDArray[Any] = np.asarray(value, dtype=dtype).view()
    view.setflags(write=False)
    return view


def sealed(array: NDArray[Any]) -> NDArray[Any]:
    """Make this array itself read-only; for the code that has just made it."""
    array.setflags(write=False)
    return array


@lru_cache(maxsize=64)
def constant(value: float, shape: tuple[int, ...], dtype: np.dtype[Any] = NUMBERS) -> NDArray[Any]:
    """An array that is the same everywhere, shared by all who ask for it."""
    array = np.full(shape, value, dtype)
    array.setflags(write=False)
    return array


def numbers(name: str, value: ArrayLike) -> FloatArray:
    """An array of floating-point numbers.

    Raises:
        ShapeError: They are no numbers, or of ragged rows.
    """
    try:
        return np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise ShapeError(f"`{name}` is {value!r}; expected an array of numbers.") from error


def fill(name: str, column: NDArray[Any], value: ArrayLike) -> None:
    """Write numbers into an array that has its shape already.

    Raises:
        ShapeError: They have another shape and are not one for all either, or are no numbers.
    """
    try:
        column[...] = value
    except (TypeError, ValueError, OverflowError) as error:
        shape = numbers(name, value).shape
        raise ShapeError(f"`{name}` has shape {shape}; expected {column.shape}.") from error
