"""Who does the work of a long command? Several processes, or this one."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context
from typing import Annotated

import typer

JobsOption = Annotated[
    int, typer.Option("--jobs", "-j", help="Processes; 0 is one per core.", min=0)
]


@contextmanager
def processes(jobs: int, units: int) -> Iterator[Executor | None]:
    """That many processes; none where a single one would do.

    Args:
        jobs: How many; 0 is one per core.
        units: Pieces of work; more processes than that are of no use.
    """
    jobs = min(jobs or os.cpu_count() or 1, units)
    if jobs <= 1:
        yield None
        return
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as executor:
        yield executor
