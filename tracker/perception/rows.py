"""What regions, detections, landmarks and bodies share: arrays whose rows belong together."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

T = TypeVar("T", bound="Rows")


class Rows:
    """A frozen dataclass with slots; row i of each of its arrays is the same thing."""

    __slots__: tuple[str, ...] = ()

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
