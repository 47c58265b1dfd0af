"""What of a recording could not be read? Told once, when the rest was."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from tracker.errors import RecordingError


class Damage:
    """Collects the damaged places of one file; memory does not grow with their number."""

    def __init__(self) -> None:
        self._places = 0
        self._first: tuple[int, str] | None = None
        self._cut_ns: int | None = None

    def add(self, log_ns: int, reason: str) -> None:
        """A place is damaged.

        Args:
            log_ns: About when.
            reason: What is wrong there.
        """
        self._places += 1
        if self._first is None or log_ns < self._first[0]:
            self._first = (log_ns, reason)

    def cut(self, log_ns: int) -> None:
        """The file ends without its end, about then."""
        self._cut_ns = log_ns

    def tell(
        self, path: Path, start_ns: int, counted: Mapping[str, int], read: Mapping[str, int]
    ) -> None:
        """Raise what there is to say, if anything.

        Args:
            path: The file.
            start_ns: Its first log time.
            counted: Messages of each topic that it says it holds.
            read: Messages of each topic that were read.

        Raises:
            RecordingError: There is damage, or fewer messages were read than counted.
        """
        what = []
        if self._first is not None:
            first_ns, reason = self._first
            places = "one place" if self._places == 1 else f"{self._places} places"
            what.append(
                f"is damaged in {places}, the first {(first_ns - start_ns) / 1e9:.3f} s after its "
                f"beginning ({reason})"
            )
        if self._cut_ns is not None:
            cut_s = (self._cut_ns - start_ns) / 1e9
            what.append(f"was cut off or never finished, {cut_s:.3f} s after its beginning")
        missing = [
            f"{read.get(topic, 0)} of {count} on {topic}"
            for topic, count in sorted(counted.items())
            if read.get(topic, 0) < count
        ]
        if missing:
            what.append(f"fewer messages were read than it counts: {', '.join(missing)}")
        if what:
            raise RecordingError(f"{path}: {'; '.join(what)}. What could be read was read.")
