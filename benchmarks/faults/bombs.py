"""Recordings that claim, or unpack to, far more than they hold."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from pathlib import Path
from zlib import crc32

import cv2
import lz4.frame
import numpy as np
import zstandard

from benchmarks.faults.recordings import Message, write_mcap
from tracker.messages.types import build, serialize

_ZEROS = 1 << 31


def bombs(folder: Path, messages: list[Message]) -> Iterator[tuple[str, Path]]:
    """Name and file of each."""
    jpeg, png = jpeg_claiming(32_000), png_of(20_000)
    for name, picture in (("picture, JPEG", jpeg), ("picture, PNG", png)):
        yield name, _with_picture(folder / f"{len(picture)}.mcap", messages, picture)
        photos = folder / f"photos_{len(picture)}"
        photos.mkdir()
        suffix = "png" if "PNG" in name else "jpg"
        (photos / f"bomb.{suffix}").write_bytes(picture)
        cv2.imwrite(str(photos / "good.png"), np.zeros((60, 80, 3), np.uint8))
        yield f"{name}, photo", photos
    for packing in ("zstd", "lz4"):
        for claim in (10**10, 300_000_000, 1000):
            path = folder / f"{packing}_{claim}.mcap"
            _with_chunk(path, messages, packing, claim)
            yield f"chunk, {packing}, claims {claim:.0e}", path
    path = folder / "bomb.mcap.zstd"
    with path.open("wb") as file, zstandard.ZstdCompressor().stream_writer(file) as stream:
        for _ in range(_ZEROS >> 20):
            stream.write(bytes(1 << 20))
    yield "file, .mcap.zstd of 2 GB", path


def jpeg_claiming(side: int) -> bytes:
    """A small JPEG whose header says that it is so large."""
    _, encoded = cv2.imencode(".jpg", np.zeros((64, 64, 3), np.uint8))
    content = bytearray(encoded.tobytes())
    at = content.index(b"\xff\xc0") + 5
    content[at : at + 4] = struct.pack(">HH", side, side)
    return bytes(content)


def png_of(side: int) -> bytes:
    """A black picture that is really so large, in a few hundred kilobytes."""

    def piece(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", crc32(kind + data))

    packer = zlib.compressobj(9)
    rows = b"".join(packer.compress(bytes(side * 3 + 1)) for _ in range(side)) + packer.flush()
    header = struct.pack(">IIBBBBB", side, side, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n" + piece(b"IHDR", header) + piece(b"IDAT", rows) + piece(b"IEND", b"")
    )


def _with_picture(path: Path, messages: list[Message], picture: bytes) -> Path:
    kind = "sensor_msgs/msg/CompressedImage"
    header = build("std_msgs/msg/Header", frame_id="camera_link")
    message = build(kind, header=header, format="jpeg", data=np.frombuffer(picture, np.uint8))
    bomb = Message("/image_raw/compressed", messages[40].log_ns, kind, serialize(message).cdr)
    write_mcap()(path, [*messages[:40], bomb, *messages[40:]])
    return path


def _with_chunk(path: Path, messages: list[Message], packing: str, claim: int) -> None:
    """A good recording with one more chunk, of zeros, before all others."""
    write_mcap()(path, messages)
    content = path.read_bytes()
    zeros = bytes(300_000_000)
    packed = zstandard.compress(zeros) if packing == "zstd" else lz4.frame.compress(zeros)
    log_ns, name = messages[0].log_ns, packing.encode()
    body = struct.pack("<QQQII", log_ns, log_ns, claim, 0, len(name)) + name
    body += struct.pack("<Q", len(packed)) + packed
    at = 8 + 9 + struct.unpack_from("<Q", content, 9)[0]  # behind the header
    path.write_bytes(content[:at] + struct.pack("<BQ", 6, len(body)) + body + content[at:])
