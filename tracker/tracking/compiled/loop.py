"""How are the functions compiled that only compiled functions call?"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from numba import njit

_Function = TypeVar("_Function", bound=Callable[..., Any])


def loop(function: _Function) -> _Function:
    """Compile it for others to call; without a way in from Python that takes a third less time.

    Python that calls it nevertheless crashes.
    """
    return _compiled(function)


def step(function: _Function) -> _Function:
    """The same, as a part of whatever calls it: for what a loop does over and over.

    A call hands over a dozen numbers for each array, which takes longer than what is done with
    them.
    """
    return _compiled(function, forceinline=True)


def _compiled(function: _Function, **options: bool) -> _Function:
    ways_in = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    compiled: _Function = njit(error_model="numpy", **ways_in, **options)(function)
    return compiled
