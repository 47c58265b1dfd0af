"""The compiled frame: its types, and where this process keeps it."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from tracker.compiling.machine import LOG, Machine
from tracker.config import Config
from tracker.containers import Measurements
from tracker.containers.arrays import sealed
from tracker.tracking.frame import track_frame
from tracker.tracking.instant import Instant
from tracker.tracking.life_cycle.renewal import Frame
from tracker.tracking.people import room_for
from tracker.tracking.prediction.motion import modes_of
from tracker.tracking.sensing.claims import claims_of
from tracker.tracking.sensing.view import view_numbers
from tracker.tracking.settings import record_of, settings_of
from tracker.tracking.trace import NO_TRACE


def frame_types() -> tuple[Any, ...]:
    """Numba's types of what a frame takes, in its order: those of a frame of nobody."""
    from numba import typeof

    config = Config()
    nobody = room_for(modes_of(config), 0, config.confirm_window)
    instant = Instant(0, 0.0, 1, -1, view_numbers(None), view_numbers(None), False, True)
    given = (
        *(nobody, claims_of(Measurements.none()), instant, sealed(np.zeros((0, 0)))),
        *(record_of(settings_of(config)), NO_TRACE),
    )
    return tuple(typeof(each) for each in given)


def compiled_frame(folder: Path | None, may_compile: bool = True) -> Callable[..., Frame]:
    """`track_frame` as machine code; `compiler.compiled` says what the arguments are."""
    from tracker.compiling.compiler import compiled

    frame: Callable[..., Frame] = compiled(track_frame, frame_types(), folder, may_compile)
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
