"""The loops of trials as machine code where numba is there, as Python otherwise.

Studies run so many frames that they wait for the compiler, once on a machine.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from hashlib import blake2b
from pathlib import Path
from types import FunctionType
from typing import Any, ParamSpec, TypeVar, cast

from tracker.compiling import files
from tracker.tracking.frame import interpreted
from tracker.tracking.machine_frame import compile_tracker, machine
from tracker.tracking.settings import Settings, record_of

_Given = ParamSpec("_Given")
_Result = TypeVar("_Result")


def machine_code(function: Callable[_Given, _Result]) -> Callable[_Given, _Result]:
    """The fastest there is of a function.

    Args:
        function: Of arrays, numbers and tuples of them, always of the same types; read-only those
            arrays that are slices of what the tracker takes. It calls `track_frame`, and what
            `tracker.compiling.loops` names.
    """
    compiled = _compiled(function)
    if compiled is None:
        return cast(Any, interpreted)(function)  # type: ignore[no-any-return]

    def run(*given: _Given.args, **named: _Given.kwargs) -> _Result:
        result: _Result = compiled(
            *(record_of(each) if isinstance(each, Settings) else each for each in given), **named
        )
        return result

    return run


@cache
def _compiled(function: Callable[..., Any]) -> Callable[..., Any] | None:
    """Machine code of whatever types the first call has; None where numba cannot be used."""
    tracker, known = machine(), dict(function.__globals__)
    if tracker is None:
        return None
    if "track_frame" in function.__code__.co_names:  # which is compiled by itself
        compile_tracker(lambda _: None)
        known["track_frame"] = tracker.code
        if tracker.code is None:
            return None
    try:
        from tracker.compiling.compiler import compiled
    except ImportError:  # numba is installed and cannot be loaded
        return None
    linked = FunctionType(function.__code__, known, function.__name__)
    code: Callable[..., Any] = compiled(linked, None, _folder())
    return code


@cache
def _folder() -> Path | None:
    """Where machine code of these sources is kept, beside the tracker's."""
    place = files.folder()
    if place is None:
        return None
    content = blake2b(digest_size=8)
    for path in sorted(Path(__file__).parent.glob("*.py")):
        content.update(path.read_bytes())
    return place / f"trials-{content.hexdigest()}"
