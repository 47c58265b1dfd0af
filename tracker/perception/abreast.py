"""How do several models run at once? Each call on a thread of its own, the caller's among them."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, wait
from typing import TypeVar

T = TypeVar("T")


class Abreast:
    """Threads that take one call after the other until none is left.

    The caller's thread works as well: one fewer has to be woken, and none shares a core with one
    that only waits.

    Args:
        threads: How many work at once, the caller's included.
    """

    def __init__(self, threads: int) -> None:
        self._threads = threads
        self._helpers: ThreadPoolExecutor | None = None
        self._process = 0

    def run(self, calls: Sequence[Callable[[], T]]) -> list[T]:
        """What each call returns; they begin in this order, so the longest should come first.

        Raises what a call raises, once the others are done.
        """
        helpers = min(self._threads, len(calls)) - 1
        if helpers < 1:
            return [call() for call in calls]
        returned: dict[int, T] = {}
        rows = iter(range(len(calls)))  # shared: each thread takes the next

        def work() -> None:
            for row in rows:
                returned[row] = calls[row]()

        pool = self._pool()
        waiting = [pool.submit(work) for _ in range(helpers)]
        try:
            work()
        finally:
            wait(waiting)
        for helper in waiting:
            helper.result()
        return [returned[row] for row in range(len(calls))]

    def _pool(self) -> ThreadPoolExecutor:
        """The other threads; a forked process has none of its parent's."""
        if self._helpers is None or self._process != os.getpid():
            self._helpers = ThreadPoolExecutor(self._threads - 1, "models")
            self._process = os.getpid()
        return self._helpers
