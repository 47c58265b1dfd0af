"""Where do a study's files go? Into a folder that is made, or into an error that names it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tracker.errors import RecordingError


@contextmanager
def writing_into(folder: str | Path) -> Iterator[None]:
    """Make the folder where it is missing; what fails while files are written names it.

    Raises:
        RecordingError: A file cannot be written.
    """
    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
        yield
    except OSError as error:
        raise RecordingError(
            f"{folder}: cannot be written ({error.strerror}); "
            "a folder that may be written and has room is needed."
        ) from error
