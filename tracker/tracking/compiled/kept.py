"""Where is machine code kept? By the content of its sources, so that no installation loses it.

The folder is in the user's cache, or where NUMBA_CACHE_DIR says. Numba's own way goes by the time
stamp of a file, and refuses to compile where it cannot write.
"""

from __future__ import annotations

import pickle
import sys
from collections.abc import Callable
from functools import cache
from hashlib import blake2b
from importlib.metadata import version
from pathlib import Path
from typing import Any

from numba import njit
from numba.core import config
from numba.core.caching import CompileResultCacheImpl, FunctionCache, _CacheLocator

from tracker.user_cache import user_cache


def kept(signature: Any = None) -> Callable[[Callable[..., Any]], Any]:
    """Compile a function, or load what was compiled before.

    Args:
        signature: Said beforehand, it is compiled now; otherwise when it is called.
    """

    def compiled(function: Callable[..., Any]) -> Any:
        dispatcher = njit(error_model="numpy")(function)
        if dispatcher is function:  # NUMBA_DISABLE_JIT
            return function
        dispatcher._cache = _Cache(function)
        if signature is not None:
            dispatcher.compile(signature)
            dispatcher.disable_compile()
        return dispatcher

    return compiled


def trouble_of(function: Any) -> str:
    """Why the machine code of a function could not be kept; empty where it is."""
    return str(getattr(getattr(function, "_cache", None), "trouble", ""))


@cache
def folder() -> Path | None:
    """Where the machine code of these sources is; None where there is no place for it."""
    place = config.CACHE_DIR or user_cache()
    if not place:
        return None
    content = blake2b(f"numba {version('numba')}, Python {sys.version}".encode(), digest_size=8)
    for path in sorted(Path(__file__).parents[1].rglob("*.py")):
        content.update(path.read_bytes())
    return Path(place) / f"compiled-{content.hexdigest()}"


class _BySources(_CacheLocator):
    def __init__(self, file: str) -> None:
        self._file = Path(file)

    def get_cache_path(self) -> str:
        return str(folder() or "")

    def get_source_stamp(self) -> str:
        return blake2b(self._file.read_bytes()).hexdigest()

    def get_disambiguator(self) -> str:
        return "kept"

    @classmethod
    def from_function(cls, _: Callable[..., Any], file: str) -> _BySources:
        return cls(file)


class _Files(CompileResultCacheImpl):
    _locator_classes = (_BySources,)


class _Cache(FunctionCache):
    """Numba's, where a file that cannot be read or written is no reason to stop."""

    _impl_class = _Files
    trouble = ""

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        try:
            return super().load_overload(sig, target_context) if folder() else None
        except OSError:
            return None
        except (EOFError, pickle.UnpicklingError, ImportError):  # cut off, or moved: begin again
            self.flush()
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        if folder() is None:
            self.trouble = "the user has no home folder"
            return
        try:
            super().save_overload(sig, data)
        except OSError as error:
            self.trouble = f"{folder()}: {error.strerror or error}"
