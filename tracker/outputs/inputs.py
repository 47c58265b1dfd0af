"""Would an output replace an input? Checked before any file is opened."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path

from tracker.errors import ConfigError
from tracker.outputs.aside import part_of


def check_inputs_stay(inputs: Iterable[Path | None], outputs: Iterable[Path | None]) -> None:
    """Refuse outputs that would replace an input, become part of one, or replace each other.

    Files are compared as the system knows them: links, `..` and other spellings are seen through.

    Args:
        inputs: Files and folders that are read; of a folder, each file inside counts. None and
            what does not exist are passed over.
        outputs: Files that will be written; None is passed over.

    Raises:
        ConfigError: One would; names both.
    """
    read = [path for path in inputs if path is not None and path.exists()]
    written = [path for path in outputs if path is not None]
    for number, output in enumerate(written):
        for source in read:
            if any(_takes(name, source) for name in (output, part_of(output))):
                raise ConfigError(
                    f"{output}: this output would replace the input {source}, or lie inside it; "
                    "choose another output."
                )
        for other in written[:number]:
            if any(
                _is_same(one, two)
                for one in (output, part_of(output))
                for two in (other, part_of(other))
            ):
                raise ConfigError(
                    f"{output}: two outputs would be written there; choose another place for one "
                    "of them."
                )


def _takes(output: Path, source: Path) -> bool:
    if not source.is_dir():
        return _is_same(output, source)
    place = Path(os.path.realpath(output))
    if _is_same(place.parent, source):
        return True
    if not place.exists():
        return False
    inside = any(_is_same(parent, source) for parent in place.parents)
    return inside or any(_is_same(place, file) for file in _files(source))


def _files(folder: Path) -> Iterator[Path]:
    for place, _, names in os.walk(folder):
        yield from (Path(place) / name for name in names)


def _is_same(a: Path, b: Path) -> bool:
    try:
        return os.path.samefile(a, b)
    except OSError:  # one of them is not there yet
        return os.path.realpath(a) == os.path.realpath(b)
