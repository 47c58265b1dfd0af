"""What regions, detections, landmarks and bodies share: arrays whose rows belong together."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Generic, TypeVar

import numpy as np

T = TypeVar("T", bound="Rows")
A = TypeVar("A", bound=np.ndarray[Any, Any])


class Rows:
    """A frozen dataclass with slots; row i of each of its arrays is the same thing."""

    # What `kept` has computed; a subclass' own slots are its fields.
    __slots__: tuple[str, ...] = ("_kept",)
    _kept: dict[Any, Any]

    def __len__(self) -> int:
        return len(getattr(self, self.__slots__[0]))

    def __getitem__(self: T, rows: Any) -> T:
        return type(self)(*(getattr(self, name)[rows] for name in self.__slots__))

    @classmethod
    def concatenate(cls: type[T], *parts: T) -> T:
        """Join batches, rows in the order given."""
        return cls(
            *(np.concatenate([getattr(part, name) for part in parts]) for name in cls.__slots__)
        )


class kept(Generic[A]):
    """A property whose array is computed once for each batch, and read-only from then on."""

    def __init__(self, compute: Callable[[Any], A]) -> None:
        self._compute = compute
        self.__doc__ = compute.__doc__

    def __get__(self, rows: Rows, kind: type) -> A:
        try:
            arrays: dict[kept[A], A] = rows._kept
        except AttributeError:
            arrays = {}
            object.__setattr__(rows, "_kept", arrays)
        if self not in arrays:
            arrays[self] = self._compute(rows)
            arrays[self].flags.writeable = False
        return arrays[self]
