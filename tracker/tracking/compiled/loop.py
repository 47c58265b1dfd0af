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
    options = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    compiled: _Function = njit(error_model="numpy", **options)(function)
    return compiled
