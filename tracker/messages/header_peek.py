"""When was this image taken? Its header, read from the bytes without decoding the rest.

Two of three images of a 30 Hz camera are passed over; decoding them would be work for nothing.
"""

from __future__ import annotations

import struct
from typing import NamedTuple

from tracker.errors import RecordingError

# Encapsulation (its second byte says little-endian), seconds, nanoseconds, length of frame_id.
_STAMP_AT, _NAME_AT = 4, 16
_LONGEST_NAME = 1024


class Header(NamedTuple):
    """A std_msgs/Header."""

    stamp_ns: int
    frame_id: str


def peek_header(cdr: bytes | memoryview) -> Header:
    """The header with which a serialized message begins.

    Args:
        cdr: An Image, CompressedImage, LaserScan or CameraInfo with its encapsulation.

    Raises:
        RecordingError: The bytes end too early, or the stamp or the frame's name is none.
    """
    if len(cdr) < _NAME_AT or cdr[0] != 0 or cdr[1] not in (0, 1):
        raise RecordingError(
            f"{len(cdr)} bytes were received that do not begin like a CDR message."
        )
    order = "<" if cdr[1] else ">"
    sec, nanosec, length = struct.unpack_from(f"{order}iII", cdr, _STAMP_AT)
    if sec < 0 or nanosec >= 1_000_000_000:
        raise RecordingError(f"A stamp of {sec} s and {nanosec} ns came; it is none.")
    name = bytes(cdr[_NAME_AT : _NAME_AT + length]) if length <= _LONGEST_NAME else b""
    if len(name) < length or length == 0 or name[-1] != 0:
        raise RecordingError(
            f"The frame_id should have {length} bytes, but the message is shorter."
        )
    try:
        return Header(sec * 1_000_000_000 + nanosec, name[:-1].decode())
    except UnicodeDecodeError as error:
        raise RecordingError(f"The frame_id is not UTF-8 text ({error.reason}).") from error
