"""The waiting list in a file, so that a node that is started again goes on with it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from tracker.containers import WaitingList
from tracker.errors import OutputError, RecordingError
from tracker.outputs.aside import writing_into


class KeptCalls:
    """The file that `waiting_list_file` names, written whenever a call changes.

    Args:
        path: Its name.
        warn: Told what cannot be read or written; the node goes on without.
    """

    def __init__(self, path: Path, warn: Callable[[str], None]) -> None:
        self._path, self._warn = path, warn
        self._kept: object = None

    def read(self) -> WaitingList | None:
        """The list of the run before; None where there is none that can be read."""
        try:
            return WaitingList.from_json(self._path.read_text(encoding="utf-8"))
        except FileNotFoundError:
            return None
        except (OSError, UnicodeDecodeError, RecordingError) as error:
            self._warn(f"waiting_list_file {self._path}: {error}")
            return None

    def keep(self, calls: WaitingList) -> None:
        """Write the list if some call has begun, changed its state or ended since."""
        outline = [(caller.id, caller.state, caller.called_ns) for caller in calls.callers]
        if outline == self._kept:
            return
        self._kept = outline
        try:
            with writing_into(self._path.parent) as new:
                new(self._path.name).write_text(calls.to_json(), encoding="utf-8")
        except OutputError as error:
            self._warn(f"waiting_list_file: {error}")
