"""Where is compiled code stored? In the user's cache, or in NUMBA_CACHE_DIR.

The folder is named after the content of the sources, the versions and the processor, so that
nothing stale is ever loaded, and no installation loses what is not.
"""

from __future__ import annotations

import os
import sys
from functools import cache
from hashlib import blake2b
from importlib.metadata import version
from pathlib import Path

from tracker.user_cache import user_cache

#: Rooms of the sources.
_ROOMS = ("compiling", "containers", "tracking")


@cache
def folder() -> Path | None:
    """Of these sources; None where there is no place for it."""
    place = os.environ.get("NUMBA_CACHE_DIR") or user_cache()
    if not place:
        return None
    from llvmlite.binding import get_host_cpu_features, get_host_cpu_name

    processor = f"{get_host_cpu_name()} {get_host_cpu_features().flatten()}"
    content = blake2b(
        f"numba {version('numba')}, Python {sys.version}, {processor}".encode(), digest_size=8
    )
    for room in _ROOMS:
        for path in sorted((Path(__file__).parents[1] / room).rglob("*.py")):
            content.update(path.read_bytes())
    return Path(place) / f"compiled-{content.hexdigest()}"


def are_in(place: Path) -> bool:
    """Whether somebody has compiled into that folder; a file there is written in one go."""
    return any(place.glob("*.nbi"))


def trouble_with(place: Path | None) -> str:
    """Why nothing can be kept there; empty where it can."""
    if place is None:
        return "the user has no home folder"
    try:
        place.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        return f"{place}: {error.strerror or error}"
    return "" if os.access(place, os.W_OK) else f"{place}: Permission denied"
