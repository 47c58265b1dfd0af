"""What was wrong with the input, and how often? Limits how often it is logged."""

from __future__ import annotations

import re
import threading
from collections.abc import Callable

#: The same kind is logged again after this time, with its count.
_AGAIN_NS = 60_000_000_000
#: Kinds told apart; a sender of nonsense cannot make us remember more.
_KINDS = 32
_VARIABLE = re.compile(r"'[^']*'|\"[^\"]*\"|\d+(?:\.\d+)?")


class FaultLog:
    """Counts faults by kind; each kind is logged at once, and then at most once a minute.

    Two texts are of one kind when they differ in numbers and quoted names only.

    Args:
        log: Told a text to be logged.
        steady_ns: A clock that never jumps.
    """

    def __init__(self, log: Callable[[str], None], steady_ns: Callable[[], int]) -> None:
        self._log = log
        self._steady_ns = steady_ns
        self._lock = threading.Lock()
        self._seen: dict[str, tuple[int, int]] = {}  # count unsaid, when said last
        self.total = 0

    def add(self, source: str, text: str) -> None:
        """Note a fault.

        Args:
            source: Where it came from, such as the input's name.
            text: What came, what was needed.
        """
        now_ns = self._steady_ns()
        kind = f"{source}: {_VARIABLE.sub('#', text)}"
        with self._lock:
            self.total += 1
            if kind not in self._seen and len(self._seen) >= _KINDS:
                kind = "others"
            unsaid, said_ns = self._seen.get(kind, (0, now_ns - _AGAIN_NS))
            is_said = now_ns - said_ns >= _AGAIN_NS
            self._seen[kind] = (0, now_ns) if is_said else (unsaid + 1, said_ns)
        if is_said:
            self._log(f"{source}: {text}" + (f" ({unsaid} more like it before)" if unsaid else ""))
