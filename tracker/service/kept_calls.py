"""The waiting list in a file, so that a node that is started again goes on with it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from tracker.containers import Caller, WaitingList
from tracker.errors import OutputError, RecordingError
from tracker.outputs.aside import writing_into

#: How far somebody on the list moves, and for how long a hand is up, until that is stored.
_MOVED_M, _UP_NS = 0.5, 1_000_000_000


class KeptCalls:
    """The file that `waiting_list_file` names, written whenever a call changes.

    Also once a second while a hand is up, and when somebody moves: a call that seems short would
    end after the restart, and the robot would drive to an old place.

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
        """Write the list if some call has begun, changed or ended since."""
        outline = [_outline(caller) for caller in calls.callers]
        if outline == self._kept:
            return
        self._kept = outline
        try:
            with writing_into(self._path.parent) as new:
                new(self._path.name).write_text(calls.to_json(), encoding="utf-8")
        except OutputError as error:
            self._warn(f"waiting_list_file: {error}")


def _outline(caller: Caller) -> tuple[object, ...]:
    """The parts of a caller that are stored again when they change."""
    x, y = (round(place_m / _MOVED_M) for place_m in caller.xy_m)
    up = (caller.called_ns, caller.is_up, caller.last_up_ns // _UP_NS)
    return caller.id, caller.state, *up, x, y
