"""How does a new file take the place of an earlier one? Written beside it, renamed when whole.

A crash, a full disk or a kill in between leaves the earlier file as it was.
"""

from __future__ import annotations

import os
from abc import abstractmethod
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from tracker.closing import Closing
from tracker.outputs.unwritable import unwritable


@contextmanager
def writing_into(folder: str | Path) -> Iterator[Callable[[str], Path]]:
    """Make a folder where it is missing, and replace some of its files at the end of the block.

    Yields:
        From a file's name to the path at which to write it. At the end of the block whatever was
        written there is renamed; after an error all of it is removed.

    Raises:
        OutputError: A file cannot be written.
    """
    targets: dict[Path, Path] = {}

    def new(name: str) -> Path:
        target = _resolved(Path(folder) / name)
        if target.exists() and not target.is_file():  # a device or a pipe takes the bytes itself
            return target
        return targets.setdefault(target, part_of(target))

    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
        yield new
        for target, part in targets.items():
            if part.exists():
                os.replace(part, target)
    except OSError as error:
        raise unwritable(folder, error) from error
    finally:
        for part in targets.values():
            part.unlink(missing_ok=True)


class GrowingFile:
    """A file that is useful before it is complete, for example after a kill.

    Under its own name where nothing stands there; else beside the earlier file, until `finish`.

    Args:
        path: Its name.

    Attributes:
        path: Where to write.

    Raises:
        OutputError: What a kill left there cannot be removed.
    """

    def __init__(self, path: Path) -> None:
        self._target = _resolved(path)
        self.path = part_of(self._target) if self._target.is_file() else self._target
        if self.path != self._target:
            try:
                self.path.unlink(missing_ok=True)
            except OSError as error:
                raise unwritable(path, error) from error

    def finish(self) -> None:
        """The file is whole and takes its name; where none was written, the earlier one goes.

        Raises:
            OutputError: It cannot be renamed.
        """
        if self.path == self._target:
            return
        try:
            if self.path.exists():
                os.replace(self.path, self._target)
            else:
                self._target.unlink(missing_ok=True)
        except OSError as error:
            raise unwritable(self._target, error) from error


class GrowingOutput(Closing):
    """Writes a `GrowingFile`: `close` when it is whole, `break_off` when an error ends it."""

    @abstractmethod
    def break_off(self) -> None:
        """Stop writing; the part that was written stays readable and replaces no earlier file."""

    def __exit__(self, *raised: object) -> None:
        if raised[0] is None:
            self.close()
        else:
            self.break_off()


def part_of(path: Path) -> Path:
    """The name under which a file is written until it is whole; its suffix stays."""
    return path.with_name(f"{path.stem}.part{path.suffix}")


def _resolved(path: Path) -> Path:
    return Path(os.path.realpath(path))  # a link stays one; the file behind it is replaced
