"""Where in a ROS 1 bag are its messages, and on which topics? Format version 2.0."""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator
from typing import BinaryIO, NamedTuple

from tracker.recording.formats.blocks import Block, Run
from tracker.recording.formats.walk import RecordWalk

_LENGTH = struct.Struct("<I")
_ENTRY_BYTES = 12  # of an index: seconds, nanoseconds, offset
_MESSAGE, _HEADER, _INDEX, _CHUNK, _CHUNK_INFO, _CONNECTION = range(2, 8)
_OPCODES = frozenset(range(2, 8))

#: Every header holds this field; how far before it the header may begin, and how long it may be.
_CANDIDATE = re.compile(rb"\x04\x00\x00\x00op=[\x02-\x07]")
_BEFORE, _LARGEST_HEADER = 300, 1 << 16


class Record(NamedTuple):
    """One record of a bag.

    Attributes:
        header: Its fields.
        data: Where its data begin, in bytes from the record's beginning.
        end: Where it ends.
    """

    header: dict[bytes, bytes]
    data: int
    end: int

    @property
    def opcode(self) -> int:
        """Its kind."""
        return self.header[b"op"][0]

    def number(self, name: bytes) -> int:
        """A field of four bytes; -1 where it is missing."""
        value = self.header.get(name, b"")
        return int(_LENGTH.unpack(value)[0]) if len(value) == _LENGTH.size else -1

    @property
    def log_ns(self) -> int:
        """When a message was recorded; -1 where that is missing."""
        return time_ns(self.header.get(b"time", b""))


def read_record(piece: bytes, at: int = 0) -> Record | None:
    """The record that begins in some bytes, if its header lies in them and makes sense."""
    if at + _LENGTH.size > len(piece):
        return None
    (length,) = _LENGTH.unpack_from(piece, at)
    start, stop = at + _LENGTH.size, at + _LENGTH.size + length
    if length > _LARGEST_HEADER or stop + _LENGTH.size > len(piece):
        return None
    header = _fields(piece[start:stop])
    opcode = header.get(b"op", b"")
    if len(opcode) != 1 or opcode[0] not in _OPCODES:
        return None
    (size,) = _LENGTH.unpack_from(piece, stop)
    data = stop + _LENGTH.size
    return Record(header, data - at, data - at + size)


def time_ns(value: bytes) -> int:
    """A time of ROS 1; -1 where it is none."""
    if len(value) != 8:
        return -1
    seconds, nanoseconds = struct.unpack("<II", value)
    return int(seconds * 1_000_000_000 + nanoseconds)


class Ros1Layout(RecordWalk):
    """What a walk over a bag finds.

    Attributes:
        blocks: In the file's order.
        connections: Topic and type name, by number.
        counts: Messages of each connection, by the indexes.
        is_indexed: Each chunk has its index.
        is_finished: The file has its end.
    """

    magic = b"#ROSBAG V2.0\n"

    def __init__(self, file: BinaryIO) -> None:
        super().__init__(file)
        self.blocks: list[Block] = []
        self.connections: dict[int, tuple[str, str]] = {}
        self.counts: dict[int, int] = {}
        self._chunks_said, self._chunks_listed = 0, 0
        self._run = Run(self.blocks)
        self.run()
        self._run.end()
        self.is_indexed = all(block.channels is not None for block in self.blocks)
        self.is_finished = 0 < self._chunks_said <= self._chunks_listed or not self.blocks

    def define(self, record: Record, data: bytes) -> None:
        """Take in a connection."""
        number = record.number(b"conn")
        topic = record.header.get(b"topic", b"").decode("utf-8", "replace")
        type_name = _fields(data).get(b"type", b"").decode("utf-8", "replace")
        if number >= 0 and topic and type_name.count("/") == 1:
            self.connections[number] = (topic, type_name.replace("/", "/msg/"))

    def take(self, offset: int, end: int) -> None:
        """As `RecordWalk.take`."""
        record = self._record(offset)
        if record is None:
            return
        data, size = offset + record.data, end - offset - record.data
        if record.opcode == _MESSAGE:
            if record.log_ns >= 0:
                self._run.add(offset, end, record.log_ns)
        elif record.opcode == _CHUNK:
            self._run.end()
            packing = record.header.get(b"compression", b"").decode("ascii", "replace")
            self.blocks.append(Block(data, size, -1, -1, packing, record.number(b"size")))
        elif record.opcode == _CONNECTION:
            self.define(record, self.at(data, min(size, _LARGEST_HEADER)))
        elif record.opcode == _HEADER:
            self._chunks_said = record.number(b"chunk_count")
        elif record.opcode == _CHUNK_INFO:
            self._chunks_listed += 1
        elif record.opcode == _INDEX and self.blocks:
            self._take_index(record.number(b"conn"), self.at(data, size))

    def lose(self) -> None:
        """As `RecordWalk.lose`."""
        self._run.end()

    def end_of(self, offset: int) -> int | None:
        """As `RecordWalk.end_of`."""
        record = self._record(offset)
        if record is None or offset + record.end > self.size:
            return None
        if record.opcode == _INDEX:
            entries = record.number(b"count") * _ENTRY_BYTES
            if entries != record.end - record.data:
                return None
        return offset + record.end

    def candidates(self, window: bytes) -> Iterator[int]:
        """As `RecordWalk.candidates`."""
        for match in _CANDIDATE.finditer(window):
            place = match.start()
            for row in range(max(place - _BEFORE, 0), place):
                (length,) = _LENGTH.unpack_from(window, row)
                if place < row + length < place + _BEFORE and read_record(window, row):
                    yield row

    def _record(self, offset: int) -> Record | None:
        record = read_record(self.at(offset, 4096))
        return record if record is not None else read_record(self.at(offset, _LARGEST_HEADER + 8))

    def _take_index(self, number: int, entries: bytes) -> None:
        times = [
            time_ns(entries[row : row + 8]) for row in range(0, len(entries) - 11, _ENTRY_BYTES)
        ]
        if not times:
            return
        self.counts[number] = self.counts.get(number, 0) + len(times)
        block = self.blocks[-1]
        known = block.channels or frozenset()
        start_ns = min(times) if block.start_ns < 0 else min(block.start_ns, *times)
        self.blocks[-1] = block._replace(
            start_ns=start_ns, end_ns=max(block.end_ns, *times), channels=known | {number}
        )


def _fields(header: bytes) -> dict[bytes, bytes]:
    """Names and values; nothing where it is no header."""
    found, row = {}, 0
    while row < len(header):
        if row + _LENGTH.size > len(header):
            return {}
        (length,) = _LENGTH.unpack_from(header, row)
        row += _LENGTH.size
        name, separator, value = header[row : row + length].partition(b"=")
        if not separator or row + length > len(header):
            return {}
        found[name] = value
        row += length
    return found
