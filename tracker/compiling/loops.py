"""How is one source both Python and machine code?

A step of the tracker is a plain function of arrays and numbers. Python runs it as it stands, and
`compiler` lets numba compile it together with all that it calls. What may stand in such a
function is what numba knows: loops, numbers, arrays, `NamedTuple`. Functions of NumPy beyond `exp`
and the like make the compiler slow, so that loops write out what is short.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

_Function = TypeVar("_Function", bound=Callable[..., Any])

#: Every function below, and how numba is to compile it. Without `_nrt` nobody counts who holds
#: which array, which costs more than the arithmetic; such a function must not make any.
LOOPS: dict[Callable[..., Any], dict[str, bool]] = {}


def step(function: _Function) -> _Function:
    """A few lines of arithmetic, which become a part of whatever calls them."""
    LOOPS[function] = {"_nrt": False, "forceinline": True}
    return function


def loop(function: _Function) -> _Function:
    """A loop over arrays that are there."""
    LOOPS[function] = {"_nrt": False}
    return function


def maker(function: _Function) -> _Function:
    """A loop that makes arrays."""
    LOOPS[function] = {}
    return function
