"""What does one tell whose file cannot be written? The cause, and what helps against that one."""

from __future__ import annotations

import errno
from pathlib import Path

from tracker.errors import OutputError

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
_FORBIDDEN = (errno.EACCES, errno.EPERM, errno.EROFS)


def unwritable(path: str | Path, error: OSError) -> OutputError:
    """The error for a file or folder that the system does not let us write."""
    if error.errno in _FULL:
        remedy = "make room on the disk, or name a place that has some"
    elif error.errno in _FORBIDDEN:
        remedy = "name a place where you may write"
    else:
        remedy = "a folder that exists, may be written and has room is needed"
    return OutputError(f"{path}: cannot be written ({error.strerror or error}); {remedy}.")
