"""How does numba compile a function? Imported only where that is wanted: numba takes a while."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

from numba import njit
from numba.core.caching import CompileResultCacheImpl, FunctionCache, _CacheLocator
from numba.extending import register_jitable

from tracker.compiling.loops import LOOPS

#: What reading a file raises that was cut off, or has anything else in it.
_GARBLED = (
    *(pickle.UnpicklingError, EOFError, ArithmeticError, AttributeError, ImportError),
    *(LookupError, MemoryError, TypeError, ValueError),
)


def compiled(
    function: Callable[..., Any], signature: Any, folder: Path | None, may_compile: bool = True
) -> Any:
    """A function that calls loops, as machine code for arguments of these types.

    Args:
        function: Plain; what it calls is decorated as `loops` says.
        signature: Numba's types of the arguments. Said beforehand, so that no array ever leads
            to another compilation; None compiles when it is called, for what it is given.
        folder: Where it is taken from, or kept; None keeps it nowhere.
        may_compile: Otherwise it is only taken from there.

    Raises:
        FileNotFoundError: It is not there, or cannot be read, and must not be compiled.
    """
    _register_loops()
    dispatcher = njit(error_model="numpy")(function)
    if folder is not None:
        dispatcher._cache = _cache_in(folder, may_compile)(function)
    if signature is not None:
        dispatcher.compile(signature)
        dispatcher.disable_compile()
    return dispatcher


def _register_loops() -> None:
    """Tell numba of the plain functions that it may compile for others."""
    for function, options in LOOPS.items():
        _register(function, **options)


@cache
def _register(function: Callable[..., Any], **options: bool) -> None:
    # Without ways in from Python the compiler has a third less to do.
    ways_in = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True, "no_rewrites": True}
    register_jitable(error_model="numpy", **ways_in, **options)(function)


def _cache_in(folder: Path, may_compile: bool) -> type[FunctionCache]:
    """Numba's cache, in a folder that says of which sources it is."""

    class Locator(_CacheLocator):
        def get_cache_path(self) -> str:
            return str(folder)

        def get_source_stamp(self) -> str:
            return folder.name

        def get_disambiguator(self) -> str:
            return "kept"

        @classmethod
        def from_function(cls, _: Callable[..., Any], __: str) -> Locator:
            return cls()

    class Files(CompileResultCacheImpl):
        _locator_classes = (Locator,)

    class Cache(FunctionCache):
        """A file that cannot be read or written is no reason to stop."""

        _impl_class = Files

        def load_overload(self, sig: Any, target_context: Any) -> Any:
            kept = None
            with suppress(OSError):
                try:
                    kept = super().load_overload(sig, target_context)
                except _GARBLED:  # compile it again
                    self.flush()
            if kept is None and not may_compile:
                raise FileNotFoundError(f"{folder} has no compiled code that can be read")
            return kept

        def save_overload(self, sig: Any, data: Any) -> None:
            with suppress(OSError, *_GARBLED):
                super().save_overload(sig, data)

    return Cache
