"""Unpacks compressed data up to a limit, whatever size it claims to have."""

from __future__ import annotations

import bz2
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

import lz4.frame
import zstandard

from tracker.errors import RecordingError

#: The largest piece of a recording that is unpacked at once, in bytes. Recorders' chunks have some
#: 1 MB, a raw picture of 8000x6000 has 144 MB.
LARGEST_BYTES = 400_000_000

#: Read and written at once, and left free on the disk, in bytes.
_STEP_BYTES, _ROOM_BYTES = 1 << 20, 200_000_000

#: A file that unpacks to more than so many times its size, and so many bytes, is a bomb.
_BOMB_RATIO, _BOMB_BYTES = 200, 1_000_000_000

ZSTD_MAGIC = b"\x28\xb5\x2f\xfd"


class DamagedError(Exception):
    """A piece of a recording does not hold what it says it does."""


def unpack(data: bytes, compression: str, size: int | None = None) -> bytes:
    """What was packed.

    Args:
        data: The packed bytes.
        compression: `lz4`, `zstd`, `bz2`, or nothing (also written `none`).
        size: How many bytes it is to become; None where that is not known.

    Raises:
        DamagedError: It is damaged, becomes more than `LARGEST_BYTES` or not `size`, or the
            compression is unknown.
    """
    if size is not None and size > LARGEST_BYTES:
        raise DamagedError(f"a chunk claims {size} bytes; up to {LARGEST_BYTES} are read")
    most = LARGEST_BYTES if size is None else size
    try:
        unpacked = _unpack(data, compression, most)
    except (zstandard.ZstdError, RuntimeError, OSError, ValueError, EOFError) as error:
        raise DamagedError(f"a chunk cannot be decompressed: {error}") from error
    if len(unpacked) > most or (size is not None and len(unpacked) != size):
        raise DamagedError(f"a chunk does not decompress to the {most} bytes that it claims")
    return unpacked


def unpack_message(data: bytes | memoryview) -> bytes:
    """A message as its sender wrote it: rosbag2 may pack each alone, and CDR begins otherwise.

    Raises:
        DamagedError: It is packed and cannot be decompressed.
    """
    return unpack(bytes(data), "zstd") if data[:4] == ZSTD_MAGIC else bytes(data)


def _unpack(data: bytes, compression: str, most: int) -> bytes:
    """Up to one byte more than `most`."""
    if compression in ("", "none"):
        return data
    if compression == "zstd":
        with zstandard.ZstdDecompressor().stream_reader(data) as stream:
            return bytes(stream.read(most + 1))
    if compression == "lz4":
        return bytes(lz4.frame.LZ4FrameDecompressor().decompress(data, max_length=most + 1))
    if compression == "bz2":
        return bz2.BZ2Decompressor().decompress(data, max_length=most + 1)
    raise DamagedError(f"a chunk is compressed with {compression!r}; known are lz4, zstd and bz2")


@contextmanager
def unpacked_file(path: Path) -> Iterator[Path]:
    """A `.zstd` file of rosbag2 as a temporary one, without that suffix.

    Raises:
        RecordingError: It cannot be read, or the disk has no room.
    """
    with tempfile.TemporaryDirectory(prefix="raised_hand_") as folder:
        target = Path(folder) / path.stem
        try:
            with path.open("rb") as packed, target.open("wb") as file:
                _copy(path, packed, file)
        except OSError as error:
            raise RecordingError(f"{path}: cannot be decompressed ({error.strerror}).") from error
        yield target


def _copy(path: Path, packed: BinaryIO, file: BinaryIO) -> None:
    folder = Path(file.name).parent
    most = _BOMB_BYTES + _BOMB_RATIO * path.stat().st_size
    with zstandard.ZstdDecompressor().stream_reader(packed, read_across_frames=True) as stream:
        while True:
            try:
                piece = stream.read(_STEP_BYTES)
            except zstandard.ZstdError:  # what came before is read, as of a file that was cut off
                return
            if not piece:
                return
            if file.tell() > most:
                raise RecordingError(
                    f"{path}: unpacks to more than {most} bytes, which no recording does; if it "
                    "is one, unpack it with `unzstd` and name what comes of it."
                )
            if shutil.disk_usage(folder).free < _ROOM_BYTES:
                raise RecordingError(
                    f"{path}: has no room on the disk of {folder} when it is unpacked; make "
                    "some, or set TMPDIR to a folder that has."
                )
            file.write(piece)
