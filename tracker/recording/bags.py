"""How are recordings of robots opened? Single files by their suffix, folders by their metadata."""

from __future__ import annotations

import re
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path, PurePath
from typing import Any

import yaml

from tracker.errors import RecordingError
from tracker.recording.formats.mcap_file import McapSource
from tracker.recording.formats.ros1_file import Ros1Source
from tracker.recording.formats.sqlite_file import SqliteSource
from tracker.recording.formats.unpacking import unpacked_file
from tracker.recording.sources import Row, Source, WrappedSource
from tracker.wording import listing

#: What each suffix, in small letters, is read by.
_SOURCES: dict[str, Callable[[Path], Source]] = {
    ".mcap": McapSource,
    ".db3": SqliteSource,
    ".bag": Ros1Source,
    ".active": Ros1Source,
}

#: Suffixes of files that rosbag2 packed as a whole.
_PACKED = (".zstd", ".zst")

#: With which rosbag2 numbers the parts of one recording.
_NUMBER = re.compile(r"_\d+$")

#: A metadata.yaml beyond it is none, in bytes.
_LARGEST_METADATA = 20_000_000


def is_bag_file(path: Path) -> bool:
    """Whether a name is that of a recording: .mcap, .db3, .bag, .bag.active, .mcap.zstd ..."""
    return _suffix(path) in _SOURCES


def open_bag(path: Path) -> Source:
    """Open a recording of a robot, whole or not.

    Args:
        path: A file that `is_bag_file`, or a folder of them.

    Raises:
        RecordingError: Nothing of it can be read.
    """
    return _open_folder(path) if path.is_dir() else _open_file(path)


def bag_files(folder: Path) -> list[Path]:
    """The parts of a rosbag2 recording, in the order in which the recorder numbered them."""
    found = [file for file in folder.iterdir() if _suffix(file) in (".mcap", ".db3")]
    return sorted(found, key=lambda file: (len(file.name), file.name))


def _suffix(path: Path) -> str:
    suffix = path.suffix.lower()
    return PurePath(path.stem).suffix.lower() if suffix in _PACKED else suffix


def _open_file(path: Path) -> Source:
    kind = _SOURCES[_suffix(path)]
    if path.suffix.lower() not in _PACKED:
        return kind(path)
    with ExitStack() as opened:
        unpacked = opened.enter_context(unpacked_file(path))
        try:
            source = kind(unpacked)
        except RecordingError as error:
            raise RecordingError(str(error).replace(str(unpacked), str(path))) from error
        opened.callback(source.close)
        return WrappedSource(source, unpacked, path, opened.pop_all())


def _open_folder(folder: Path) -> Source:
    files, notes = _listed(folder)
    parts: list[Source] = []
    broken: list[str] = []
    for file in files:
        try:
            parts.append(_open_file(file))
        except RecordingError as error:
            broken.append(str(error))
    if not parts:
        reason = broken[0] if broken else f"{folder}: contains no recording."
        raise RecordingError(f"{reason} `ros2 bag reindex` renews a folder's metadata.yaml.")
    return Row("ROS 2 recording", parts, notes, broken)


def _listed(folder: Path) -> tuple[list[Path], list[str]]:
    """The files that metadata.yaml lists, or all there are; and what is odd about them."""
    there = bag_files(folder)
    metadata = folder / "metadata.yaml"
    names = _names_in(metadata) if metadata.exists() else []
    listed = [folder / PurePath(name).name for name in names]
    if listed and all(file.is_file() and is_bag_file(file) for file in listed):
        return listed, []
    state = "cannot be used" if metadata.exists() else "is missing"
    names_of = {_NUMBER.sub("", file.name.split(".")[0]) for file in there}
    if len(names_of) > 1:
        raise RecordingError(
            f"{folder}: contains several recordings, {listing(file.name for file in there)}; "
            "name one of them."
        )
    missing = [file.name for file in listed if not file.is_file()]
    if missing:
        state = f"names {missing[0]}, which does not exist"
    return there, [f"{folder}: metadata.yaml {state}; read by file."]


def _names_in(metadata: Path) -> list[str]:
    try:
        if metadata.stat().st_size > _LARGEST_METADATA:
            return []
        said: Any = yaml.safe_load(metadata.read_text(encoding="utf-8"))
        names = said["rosbag2_bagfile_information"]["relative_file_paths"]
    except (OSError, UnicodeDecodeError, yaml.YAMLError, KeyError, TypeError, RecursionError):
        return []
    return [str(name) for name in names] if isinstance(names, list) else []
