"""Which texts are stored in an ONNX file, and is it still what was written?

Read by hand rather than with `onnx`: importing that takes longer than everything else a robot
does with its model files at start-up, and this touches only the file's first and last pages.

Source: onnx.proto (ModelProto, StringStringEntryProto) and the Protocol Buffers encoding,
    https://protobuf.dev/programming-guides/encoding/
"""

import mmap
from collections.abc import Iterator
from hashlib import blake2b
from pathlib import Path

# Field numbers in onnx.proto.
_MODEL_METADATA = 14
_ENTRY_KEY = 1
_ENTRY_VALUE = 2

#: The last entry of a sealed file; its value is the hash of all before it.
_SEAL_KEY = b"content_blake2b"
_HASH_LENGTH = 64

_Buffer = bytes | mmap.mmap


def read_metadata(path: Path) -> dict[str, str]:
    """Read the metadata properties of an ONNX file.

    Args:
        path: The file.

    Returns:
        Texts by key; empty if there are none, or if the file is cut off or no ONNX file.

    Raises:
        OSError: The file is not there or must not be read.
    """
    with path.open("rb") as file:
        try:
            with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
                pairs = [
                    {field: value.decode() for field, value in _length_delimited(entry)}
                    for field, entry in _length_delimited(content)
                    if field == _MODEL_METADATA
                ]
        except (ValueError, IndexError):  # an empty file, or not what the encoding allows
            return {}
    return {pair.get(_ENTRY_KEY, ""): pair.get(_ENTRY_VALUE, "") for pair in pairs}


def sealed(content: bytes) -> bytes:
    """An ONNX file with the hash of its content as one more metadata property, at its end."""
    return content + _seal(content)


def has_seal(path: Path) -> bool | None:
    """Whether the content of a file fits its seal; None where it has no seal.

    Raises:
        OSError: The file is not there or must not be read.
    """
    content = path.read_bytes()
    length = len(_seal(b""))
    whole, seal = content[:-length], content[-length:]
    if not seal.startswith(_seal(b"")[:-_HASH_LENGTH]):
        return None
    return seal == _seal(whole)


def _seal(content: bytes) -> bytes:
    value = blake2b(content, digest_size=_HASH_LENGTH // 2).hexdigest().encode()
    entry = _field(_ENTRY_KEY, _SEAL_KEY) + _field(_ENTRY_VALUE, value)
    return _field(_MODEL_METADATA, entry)


def _field(number: int, content: bytes) -> bytes:
    """A field of less than 128 bytes."""
    return bytes((number << 3 | 2, len(content))) + content


def _length_delimited(content: _Buffer) -> Iterator[tuple[int, bytes]]:
    """Number and content of every field that is a text, a message or a list."""
    position = 0
    while position < len(content):
        tag, position = _varint(content, position)
        field, wire_type = tag >> 3, tag & 7
        if wire_type == 0:
            _, position = _varint(content, position)
        elif wire_type == 2:
            length, position = _varint(content, position)
            if position + length > len(content):
                raise ValueError("cut off")
            yield field, content[position : position + length]
            position += length
        elif wire_type in (1, 5):
            position += 8 if wire_type == 1 else 4
        else:
            raise ValueError(f"wire type {wire_type}")


def _varint(content: _Buffer, position: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        byte = content[position]
        value |= (byte & 0x7F) << shift
        position += 1
        shift += 7
        if byte < 0x80:
            return value, position
        if shift > 63:
            raise ValueError("varint too long")
