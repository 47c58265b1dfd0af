"""Ways to harm a file: each gives the new bytes, and which of the old ones it touched."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

#: New content, first byte touched, byte after the last one touched.
Harmed = tuple[bytes, int, int]
Harm = Callable[[bytes, np.random.Generator], Harmed]


def cut(content: bytes, rng: np.random.Generator) -> Harmed:
    """The end is missing."""
    at = int(rng.integers(len(content)))
    return content[:at], at, len(content)


def flip(content: bytes, rng: np.random.Generator) -> Harmed:
    """One bit is another."""
    at = int(rng.integers(len(content)))
    changed = bytearray(content)
    changed[at] ^= 1 << int(rng.integers(8))
    return bytes(changed), at, at + 1


def flip_at_the_ends(content: bytes, rng: np.random.Generator) -> Harmed:
    """One byte of the first or the last thousand is another: headers and indexes."""
    room = min(1000, len(content) // 2)
    at = int(rng.integers(room))
    at = at if rng.integers(2) else len(content) - 1 - at
    changed = bytearray(content)
    changed[at] ^= int(rng.integers(1, 256))
    return bytes(changed), at, at + 1


def insert(content: bytes, rng: np.random.Generator) -> Harmed:
    """Up to forty bytes too many."""
    at = int(rng.integers(len(content)))
    more = rng.integers(0, 256, int(rng.integers(1, 40)), dtype=np.uint8).tobytes()
    return content[:at] + more + content[at:], at, at + 1


def delete(content: bytes, rng: np.random.Generator) -> Harmed:
    """Up to forty bytes too few."""
    at = int(rng.integers(len(content)))
    end = min(at + int(rng.integers(1, 40)), len(content))
    return content[:at] + content[end:], at, end


def overwrite(content: bytes, rng: np.random.Generator) -> Harmed:
    """A page of something else, or of nothing, as after a crash of the machine."""
    at = int(rng.integers(len(content)))
    end = min(at + 4096, len(content))
    fill = rng.integers(0, 256, end - at, dtype=np.uint8).tobytes()
    if rng.integers(2):
        fill = bytes(end - at)
    return content[:at] + fill + content[end:], at, end


HARMS: tuple[Harm, ...] = (cut, flip, flip_at_the_ends, insert, delete, overwrite)
