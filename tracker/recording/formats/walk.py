"""How does one get through a file of records past damaged places?

Each record says how long it is, so that no index is needed. Where one says nonsense, the walk goes
on at the next place at which several records in a row make sense.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from typing import BinaryIO

#: Records in a row that must make sense after a damaged place, and bytes searched at once.
_IN_A_ROW, _WINDOW, _OVERLAP = 3, 1 << 20, 1 << 10


class RecordWalk(ABC):
    """Visits every record of a file that makes sense.

    Attributes:
        magic: The bytes with which such a file begins; they may come again.
        size: Of the file, in bytes.
        damages: Offsets at which the walk lost its way.
    """

    magic: bytes

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self.size = file.seek(0, 2)
        self.damages: list[int] = []

    def run(self) -> None:
        """Walk from the file's beginning to its end."""
        offset = 0
        while offset < self.size:
            offset = self._step(offset)

    @abstractmethod
    def end_of(self, offset: int) -> int | None:
        """Where the record at an offset ends; None if there is none that makes sense."""

    @abstractmethod
    def candidates(self, window: bytes) -> Iterator[int]:
        """Where in a piece of the file a record might begin, in order."""

    @abstractmethod
    def take(self, offset: int, end: int) -> None:
        """A record that makes sense."""

    @abstractmethod
    def lose(self) -> None:
        """The next record does not follow the last one."""

    def at(self, offset: int, size: int) -> bytes:
        """Bytes of the file, fewer at its end."""
        self._file.seek(offset)
        return self._file.read(size)

    def _step(self, offset: int) -> int:
        if self._is_magic(offset):
            return offset + len(self.magic)
        end = self.end_of(offset)
        if end is None:
            return self._lost(offset, self._search(offset + 1))
        if end < self.size and not self._is_beginning(end):
            found = self._search(offset + 1)
            if found < end:  # bytes are missing in this one, or it is none
                return self._lost(offset, found)
            self.take(offset, end)
            return self._lost(end, found)
        self.take(offset, end)
        return end

    def _lost(self, offset: int, found: int) -> int:
        self.lose()
        if found < self.size:  # else it is the end that is missing
            self.damages.append(offset)
        return found

    def _search(self, offset: int) -> int:
        """The next place at which records make sense; the file's end where there is none."""
        while offset < self.size:
            window = self.at(offset, _WINDOW + _OVERLAP)
            for row in self.candidates(window):
                if self._makes_sense(offset + row):
                    return offset + row
            offset += _WINDOW
        return self.size

    def _makes_sense(self, offset: int) -> bool:
        for _ in range(_IN_A_ROW):
            end = self.end_of(offset)
            if end is None:
                return self._is_magic(offset)
            if end == self.size:
                return True
            offset = end
        return True

    def _is_beginning(self, offset: int) -> bool:
        return self.end_of(offset) is not None or self._is_magic(offset)

    def _is_magic(self, offset: int) -> bool:
        return self.at(offset, len(self.magic)) == self.magic
