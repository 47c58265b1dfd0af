"""The error for a file that cannot be written: the cause, and what helps."""

from __future__ import annotations

import errno
from pathlib import Path

from tracker.errors import OutputError

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
_FORBIDDEN = (errno.EACCES, errno.EPERM, errno.EROFS)


def unwritable(path: str | Path, error: OSError) -> OutputError:
    """The error for a file or folder that the system does not let us write."""
    if error.errno in _FULL:
        remedy = "free some space on the disk, or choose another place"
    elif error.errno in _FORBIDDEN:
        remedy = "choose a place where you may write"
    else:
        remedy = "choose an existing, writable folder with free space"
    return OutputError(f"{path}: cannot be written ({error.strerror or error}); {remedy}.")
