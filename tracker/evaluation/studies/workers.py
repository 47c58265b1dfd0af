"""Who runs the units of a study, in which order do they come back, and what if a worker dies?

Any `concurrent.futures` executor will do: threads, `Processes` of this machine, a Dask cluster
(`cluster.py`).
"""

from __future__ import annotations

import os
import signal
from collections import deque
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from contextlib import suppress
from itertools import islice
from multiprocessing import Pipe, get_context
from multiprocessing.connection import Connection
from threading import Thread
from typing import Any, TypeVar

from tracker.errors import WorkerError

Result = TypeVar("Result")

#: Units on their way at a time, which bounds the memory: four for each of a thousand workers.
_WINDOW = 4096
#: So many deaths of workers with no unit finished in between are no accident; Dask says the same.
_DEATHS = 3


def run_in_order(
    units: Iterable[Callable[[], Result]], executor: Executor | None
) -> Generator[Result, None, None]:
    """Run calls, however many, and give what they return in the order of the calls.

    Where a worker's death breaks the executor, its unfinished calls are submitted again.

    Args:
        units: Calls that can be sent to other processes.
        executor: Who runs them; here and now where None.

    Raises:
        WorkerError: Workers die again and again.
    """
    if executor is None:
        yield from (unit() for unit in units)
        return
    units, deaths = iter(units), 0
    waiting: deque[tuple[Callable[[], Result], Future[Result]]] = deque()
    try:
        while True:
            for unit in islice(units, _WINDOW - len(waiting)):
                waiting.append((unit, executor.submit(unit)))
            if not waiting:
                return
            try:
                result = waiting[0][1].result()
            except BrokenExecutor:
                deaths += 1
                if deaths > _DEATHS:
                    raise
                waiting = deque(
                    (unit, executor.submit(unit) if _is_broken(future) else future)
                    for unit, future in waiting
                )
                continue
            waiting.popleft()
            deaths = 0
            yield result
    except BrokenExecutor as error:
        raise WorkerError(
            f"Workers died {deaths} times and no unit of work was finished in between; often "
            "there is too little memory for so many at once. Use fewer processes (--jobs)."
        ) from error
    finally:
        for _, future in waiting:
            future.cancel()


class Processes(Executor):
    """Processes of this machine; if a pool breaks, the next call opens a new one.

    Each process is on a leash, a pipe whose other end is held here: at a tug, or when the end is
    let go because this process dies, they leave at once. The pool's own farewell could wait
    forever for a process that stands behind a lock which a killed one has taken with it.

    Args:
        count: How many.
    """

    def __init__(self, count: int) -> None:
        self._count = count
        self._worker_end, self._leash = Pipe()
        self._pool = self._open()

    def submit(self, call: Callable[..., Any], /, *args: Any, **words: Any) -> Future[Any]:
        """Have a call run by one of the processes."""
        try:
            return self._pool.submit(call, *args, **words)
        except BrokenExecutor:
            self._pool = self._open()
            return self._pool.submit(call, *args, **words)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = True) -> None:
        """End the processes; by default, unfinished calls are dropped."""
        self._pool.shutdown(wait and not cancel_futures, cancel_futures=cancel_futures)
        if cancel_futures and not self._leash.closed:
            self._worker_end.close()
            with self._leash as leash, suppress(EOFError, OSError):
                leash.send("leave")
                if wait:
                    leash.recv()  # ends when the last process is gone, which closes the pipe

    def _open(self) -> ProcessPoolExecutor:
        return ProcessPoolExecutor(
            self._count,
            mp_context=get_context("spawn"),
            initializer=_leave_in_time,
            initargs=(self._worker_end,),
        )


def _is_broken(future: Future[Any]) -> bool:
    return future.done() and isinstance(future.exception(), BrokenExecutor)


def _leave_in_time(leash: Connection) -> None:
    """A process of the pool ends silently at Ctrl-C, and when its parent is gone."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    Thread(target=_leave_with, args=(leash,), daemon=True).start()


def _leave_with(leash: Connection) -> None:
    with suppress(OSError):
        leash.poll(None)  # what was sent is left there, for the others to see
    os._exit(1)
