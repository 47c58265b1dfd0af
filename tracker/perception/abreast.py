"""How do several models run at once? Each call on a thread of its own, the caller's among them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
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
        self.threads = threads
        self._helpers = ThreadPoolExecutor(threads - 1, "models") if threads > 1 else None

    def run(self, calls: Sequence[Callable[[], T]]) -> list[T]:
        """What each call returns; they begin in this order, so the longest should come first.

        Raises what a call raises, once the others are done.
        """
        if self._helpers is None or len(calls) < 2:
            return [call() for call in calls]
        returned: dict[int, T] = {}
        rows = iter(range(len(calls)))  # shared: each thread takes the next

        def work() -> None:
            for row in rows:
                returned[row] = calls[row]()

        helpers = min(self.threads, len(calls)) - 1
        waiting = [self._helpers.submit(work) for _ in range(helpers)]
        try:
            work()
        finally:
            for helper in waiting:
                # One that has not begun has nothing left to do; in a forked process none begins.
                if not helper.cancel():
                    helper.result()
        return [returned[row] for row in range(len(calls))]
