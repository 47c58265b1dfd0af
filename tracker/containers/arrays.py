"""How are batches of arrays kept: of one type, of one length, and read-only?"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any, TypeAlias, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracker.errors import ClockError, ShapeError

FloatArray: TypeAlias = NDArray[np.float64]
IntArray: TypeAlias = NDArray[np.int64]
BoolArray: TypeAlias = NDArray[np.bool_]
ImageArray: TypeAlias = NDArray[np.uint8]
NUMBERS, COUNTS, FLAGS = np.dtype(np.float64), np.dtype(np.int64), np.dtype(np.bool_)
#: What stands in each row of a batch's arrays: the type of the numbers and the shape.
Layout: TypeAlias = Mapping[str, tuple["np.dtype[Any]", tuple[int, ...]]]
_Batch = TypeVar("_Batch")


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


def check_rows(batch: Any, count: int, layout: Layout) -> None:
    """Make a batch's arrays read-only and see to it that each has as many rows.

    Raises:
        ShapeError: An array has other rows than the layout says, or another number of them.
    """
    fits = True
    for name, (dtype, row) in layout.items():
        given = getattr(batch, name)
        array = frozen(given, dtype)
        if array is not given:
            object.__setattr__(batch, name, array)
        fits = fits and array.shape == (count, *row)
    if not fits:
        shapes = ", ".join(f"{name} {getattr(batch, name).shape}" for name in layout)
        raise ShapeError(f"{type(batch).__name__} disagree in shape: {shapes}.")


def trusted(kind: type[_Batch], /, **columns: Any) -> _Batch:
    """A batch without checks, for arrays that are known to fit and to be read-only.

    Frozen classes with slots are filled one call after the other, so these have none.
    """
    batch = object.__new__(kind)
    batch.__dict__.update(columns)
    return batch


def select(batch: _Batch, rows: Any) -> _Batch:
    """The same batch with some rows alone; one number gives a batch of one.

    Raises:
        ShapeError: The rows are no mask, slice or list of numbers.
    """
    if isinstance(rows, (int, np.integer)):
        rows = [rows]
    chosen = dict(batch.__dict__)
    for name, each in chosen.items():
        if isinstance(each, np.ndarray):
            part = each[rows]
            if part.ndim != each.ndim:
                raise ShapeError(
                    f"Rows {rows!r} were given; expected a mask, a slice or a list of numbers."
                )
            chosen[name] = sealed(part)
    return trusted(type(batch), **chosen)


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
