"""The compiled frame: its types, and where this process keeps it."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

from tracker.compiling.machine import LOG, Machine
from tracker.tracking.frame import track_frame
from tracker.tracking.instant import Instant
from tracker.tracking.life_cycle.renewal import Frame
from tracker.tracking.people import People
from tracker.tracking.sensing.claims import Claims
from tracker.tracking.settings import RECORD
from tracker.tracking.trace import Trace


class FrameTypes(NamedTuple):
    """Numba's types of what a frame takes, in its order, and of what it gives."""

    people: Any
    claims: Any
    instant: Any
    likeness: Any
    settings: Any
    trace: Any
    frame: Any


def frame_types() -> FrameTypes:
    """The types; what is given from outside is read-only."""
    from numba import from_dtype, types

    def arrays(letters: str, kind: Any, readonly: bool = True) -> list[Any]:
        return [types.Array(kind, int(each), "C", readonly=readonly) for each in letters]

    number, whole, truth = types.float64, types.int64, types.boolean
    people = types.NamedTuple(
        [
            *arrays("2342", number, readonly=False),
            *arrays("2", whole, readonly=False),
            *arrays("22", truth, readonly=False),
        ],
        People,
    )
    claims = types.NamedTuple(
        [
            *(*arrays("23", number), *arrays("1", whole), *arrays("23", number)),
            *(*arrays("1", truth), *arrays("111", whole), *arrays("3", number)),
        ],
        Claims,
    )
    instant = types.NamedTuple(
        [whole, number, whole, whole, *arrays("11", number), truth, truth], Instant
    )
    trace = types.NamedTuple(
        [*arrays("3111", whole, readonly=False), *arrays("343", number, readonly=False)], Trace
    )
    merged = arrays("34", number, readonly=False)
    frame = types.NamedTuple([people, *merged, whole, whole, whole], Frame)
    likeness = arrays("2", number)[0]
    return FrameTypes(people, claims, instant, likeness, from_dtype(RECORD), trace, frame)


def compiled_frame(folder: Path | None, may_compile: bool = True) -> Callable[..., Frame]:
    """`track_frame` as machine code; `compiler.compiled` says what the arguments are."""
    from tracker.compiling.compiler import compiled

    *given, result = frame_types()
    frame: Callable[..., Frame] = compiled(track_frame, result(*given), folder, may_compile)
    return frame


def _can_compile() -> bool:
    try:
        is_there = find_spec("numba") is not None
    except (ImportError, ValueError):  # somebody keeps it out
        return False
    return is_there and os.environ.get("NUMBA_DISABLE_JIT", "0") in ("", "0")


@cache
def machine() -> Machine | None:
    """The machine code of this process; None without numba."""
    if not _can_compile():
        LOG.warning("numba cannot be used here; the tracker runs as Python, which is slow.")
        return None
    return Machine(compiled_frame)


def begin_compiling(say: Callable[[str], None], warn: Callable[[str], None]) -> None:
    """Load the compiled frame, or let it be compiled while frames run as Python; see `Machine`."""
    compiler = machine()
    if compiler is not None:
        compiler.start(say, warn)


def compile_tracker(say: Callable[[str], None]) -> None:
    """Load the compiled frame, or compile it now, so that no frame is slow.

    Args:
        say: Gets a sentence before the compiler runs, and one where its work cannot be kept.
    """
    compiler = machine()
    if compiler is not None:
        compiler.finish(say)
