"""Which sources is machine code of? Numba looks at the file of a function, not at others."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from hashlib import blake2b
from pathlib import Path
from typing import TypeVar

_Function = TypeVar("_Function", bound=Callable[..., object])


def named_after_sources(function: _Function) -> _Function:
    """Give a function a name that changes with any source of `tracker.tracking`.

    Numba files machine code under that name; what was compiled from other sources, or with other
    constants, is not found under it.
    """
    function.__qualname__ += f"_{_digest()}"
    return function


@cache
def _digest() -> str:
    stamp = blake2b(digest_size=4)
    for path in sorted(Path(__file__).parents[1].rglob("*.py")):
        state = path.stat()
        stamp.update(f"{path.name} {state.st_mtime_ns} {state.st_size}\n".encode())
    return stamp.hexdigest()
