"""How large does an image file say that it is? Read from its first bytes, before decoding."""

from __future__ import annotations

import re
import struct
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tracker.errors import RecordingError

#: Of a camera of today, with room to spare; decoded it takes 150 MB.
MAX_PIXELS = 50_000_000

#: JPEG markers that begin a frame, by its coding; and those that stand alone, without a length.
_JPEG_FRAMES = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}
_JPEG_MARKER = re.compile(rb"\xff[^\x00\xff]", re.DOTALL)
_JPEG_ALONE = frozenset({0x01, *range(0xD0, 0xD9)})
_TIFF_SIZE_TAGS = {256: "width", 257: "height", 322: "tile_width", 323: "tile_height"}


class PictureSize(NamedTuple):
    """Columns and rows."""

    width: int
    height: int


def picture_size(contents: NDArray[np.uint8]) -> PictureSize | None:
    """The size in the header of a JPEG, PNG, WebP, BMP or TIFF file.

    Args:
        contents: Shape (bytes,), uint8.

    Returns:
        None where it is no such file, or the header is broken.
    """
    data = np.ascontiguousarray(contents).data
    head = data[:12].tobytes()
    try:
        if head[:2] == b"\xff\xd8":
            return _jpeg(data)
        if head[:8] == b"\x89PNG\r\n\x1a\n":
            return PictureSize(*struct.unpack_from(">II", data, 16))
        if head[:4] == b"RIFF" and head[8:12] == b"WEBP":
            return _webp(data)
        if head[:2] == b"BM":
            return _bmp(data)
        if head[:4] in (b"II*\0", b"MM\0*"):
            return _tiff(data)
    except (struct.error, IndexError):  # the file ends within its header
        pass
    return None


def check_pixels(size: PictureSize, max_pixels: int, what: str) -> None:
    """Refuse a picture that is too large to be decoded.

    Raises:
        RecordingError: It has more pixels than `max_pixels`.
    """
    if size.width * size.height > max_pixels:
        raise RecordingError(
            f"{what} claims to have {size.width}x{size.height} pixels; at most {max_pixels} "
            "are decoded. Send smaller pictures, or raise picture_max_pixels."
        )


def _jpeg(data: memoryview) -> PictureSize | None:
    at = 2
    while True:
        found = _JPEG_MARKER.search(data, at)  # fill bytes and stray ones are passed over
        if found is None:
            return None
        at = found.start()
        marker = data[at + 1]
        if marker in _JPEG_FRAMES:
            height, width = struct.unpack_from(">HH", data, at + 5)
            return PictureSize(width, height)
        if marker in (0xD9, 0xDA):  # the end, or the pixels, and no frame before
            return None
        at += 2 if marker in _JPEG_ALONE else 2 + struct.unpack_from(">H", data, at + 2)[0]


def _webp(data: memoryview) -> PictureSize | None:
    kind = bytes(data[12:16])
    if kind == b"VP8X":
        width, height = (int.from_bytes(data[at : at + 3], "little") for at in (24, 27))
        return PictureSize(width + 1, height + 1) if len(data) >= 30 else None
    if kind == b"VP8L":
        (bits,) = struct.unpack_from("<I", data, 21)
        return PictureSize((bits & 0x3FFF) + 1, (bits >> 14 & 0x3FFF) + 1)
    if kind == b"VP8 ":
        width, height = struct.unpack_from("<HH", data, 26)
        return PictureSize(width & 0x3FFF, height & 0x3FFF)
    return None


def _bmp(data: memoryview) -> PictureSize:
    is_old = struct.unpack_from("<I", data, 14)[0] == 12  # OS/2
    width, height = struct.unpack_from("<HH" if is_old else "<ii", data, 18)
    return PictureSize(abs(width), abs(height))  # a negative height: from the top down


def _tiff(data: memoryview) -> PictureSize | None:
    order = "<" if data[0] == ord("I") else ">"
    (at,) = struct.unpack_from(f"{order}I", data, 4)
    (entries,) = struct.unpack_from(f"{order}H", data, at)
    found: dict[str, int] = {}
    for entry in range(at + 2, at + 2 + 12 * entries, 12):
        tag, kind = struct.unpack_from(f"{order}HH", data, entry)
        if tag in _TIFF_SIZE_TAGS:
            (value,) = struct.unpack_from(f"{order}{'H' if kind == 3 else 'I'}", data, entry + 8)
            found[_TIFF_SIZE_TAGS[tag]] = value
    if not {"width", "height"} <= found.keys():
        return None
    # A tile is decoded as a whole, and may claim more than the picture.
    return PictureSize(
        max(found["width"], found.get("tile_width", 0)),
        max(found["height"], found.get("tile_height", 0)),
    )
