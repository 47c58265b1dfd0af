"""Who may write into a folder? One command at a time."""

from __future__ import annotations

import sys
from pathlib import Path

from tracker.closing import Closing
from tracker.errors import ConfigError
from tracker.outputs.unwritable import unwritable

if sys.platform == "win32":
    import msvcrt

    def _take(number: int) -> None:
        msvcrt.locking(number, msvcrt.LK_NBLCK, 1)
else:
    import fcntl

    def _take(number: int) -> None:
        fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)


class FolderLock(Closing):
    """Locks a folder for this process; the system unlocks it when the process ends.

    The file `.lock` stays: were it taken away, two could hold one each.

    Args:
        folder: Made where it is missing.

    Raises:
        ConfigError: Somebody else writes there.
        OutputError: Nothing can be written there.
    """

    def __init__(self, folder: Path) -> None:
        try:
            folder.mkdir(parents=True, exist_ok=True)
            path = folder / ".lock"
            if path.exists() and not path.is_file():
                raise ConfigError(
                    f"{path}: is not a file, but the folder's lock file must be there. Remove it."
                )
            self._file = path.open("ab")
        except OSError as error:
            raise unwritable(folder, error) from error
        try:
            _take(self._file.fileno())
        except (BlockingIOError, PermissionError) as error:
            self.close()
            raise ConfigError(
                f"{folder}: another command is writing there; wait until it ends, or choose "
                "another folder."
            ) from error
        except OSError:  # a disk that knows no locks: then nobody is kept out
            pass

    def close(self) -> None:
        """Let go of the folder."""
        self._file.close()
