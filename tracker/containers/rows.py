"""What do hands, measurements, people and places share? Arrays whose rows belong together.

A subclass is a frozen dataclass without slots. Each of its array fields is a column, which says in
its annotation what stands in a row:

    xy_m: Annotated[FloatArray, Column((2,))]
    seated: Annotated[FloatArray, Column(missing=np.nan)] = None
    score: FloatArray                  # one number in each row

Other fields, such as a stamp, hold for all rows.
"""

from __future__ import annotations

from dataclasses import fields
from typing import (
    Annotated,
    Any,
    ClassVar,
    NamedTuple,
    TypeVar,
    get_args,
    get_origin,
    get_type_hints,
)

import numpy as np

from tracker.containers.arrays import constant, frozen, sealed
from tracker.errors import ShapeError

_Batch = TypeVar("_Batch", bound="Rows")


class Column(NamedTuple):
    """What stands in each row of an array.

    Attributes:
        shape: Of one row; -1 stands for any length.
        missing: What stands everywhere where None is given.
    """

    shape: tuple[int, ...] = ()
    missing: float | None = None


class Rows:
    """Row i of each column is the same thing; the arrays are read-only.

    Raises:
        ShapeError: A column has other rows than its annotation says, or another number of them
            than the first column.
    """

    _columns: ClassVar[dict[str, tuple[np.dtype[Any], Column]]]
    _first: ClassVar[str]

    def __init_subclass__(cls) -> None:
        hints = get_type_hints(cls, include_extras=True)
        cls._columns = {name: _column(hint) for name, hint in hints.items() if _is_array(hint)}
        cls._first = next(iter(cls._columns))

    def __post_init__(self) -> None:
        count, fits = len(self), True
        for name, (dtype, column) in self._columns.items():
            given = getattr(self, name)
            if given is None and column.missing is not None:
                array = constant(column.missing, (count, *column.shape), dtype)
            else:
                array = frozen(given, dtype)
            if array is not given:
                object.__setattr__(self, name, array)
            needed = (count, *column.shape)
            fits = fits and (array.shape == needed or _is_like(array.shape, needed))
        if not fits:
            shapes = ", ".join(f"{name} {getattr(self, name).shape}" for name in self._columns)
            raise ShapeError(f"{type(self).__name__} disagree in shape: {shapes}.")

    def __len__(self) -> int:
        return len(getattr(self, self._first))

    def __getitem__(self: _Batch, rows: Any) -> _Batch:
        """The same batch with some rows alone; one number gives a batch of one.

        Raises:
            ShapeError: The rows are no mask, slice or list of numbers.
        """
        if isinstance(rows, (int, np.integer)):
            rows = [rows]
        chosen = self._fields()
        for name in self._columns:
            part = chosen[name][rows]
            if part.ndim != chosen[name].ndim:
                raise ShapeError(
                    f"Rows {rows!r} were asked for; needed: a mask, a slice or a list of numbers."
                )
            chosen[name] = sealed(part)
        return trusted(type(self), **chosen)

    def _fields(self) -> dict[str, Any]:
        """The fields alone, without what `functools.cached_property` has added."""
        return {name: self.__dict__[name] for name in self.__match_args__}  # type: ignore[attr-defined]

    @classmethod
    def concatenate(cls: type[_Batch], *parts: _Batch) -> _Batch:
        """Join batches, rows in the order given; what holds for all rows is the first batch's."""
        if not parts:
            return cls.none()
        joined = parts[0]._fields()
        for name in cls._columns:
            joined[name] = sealed(np.concatenate([getattr(part, name) for part in parts]))
        return trusted(cls, **joined)

    @classmethod
    def none(cls: type[_Batch], *others: Any) -> _Batch:
        """A batch without rows.

        Args:
            others: What holds for all rows, in the order of those fields, such as a stamp.
        """
        columns = {
            name: np.zeros((0, *(max(length, 0) for length in column.shape)), dtype)
            for name, (dtype, column) in cls._columns.items()
        }
        names = [item.name for item in fields(cls) if item.name not in columns]  # type: ignore[arg-type]
        return cls(**columns, **dict(zip(names, others, strict=False)))


def trusted(kind: type[_Batch], /, **values: Any) -> _Batch:
    """A batch whose arrays are known to fit and to be read-only: nobody looks at them again.

    Frozen classes with slots are filled one call after the other, so these have none.
    """
    batch = object.__new__(kind)
    batch.__dict__.update(values)
    return batch


def _is_array(hint: Any) -> bool:
    return get_origin(get_args(hint)[0] if get_origin(hint) is Annotated else hint) is np.ndarray


def _column(hint: Any) -> tuple[np.dtype[Any], Column]:
    array, column = get_args(hint) if get_origin(hint) is Annotated else (hint, Column())
    (number,) = get_args(get_args(array)[-1])  # of NDArray[number], which is ndarray[.., dtype]
    return np.dtype(number), column


def _is_like(shape: tuple[int, ...], needed: tuple[int, ...]) -> bool:
    return len(shape) == len(needed) and all(
        is_ == needs or needs < 0 for is_, needs in zip(shape, needed, strict=True)
    )
