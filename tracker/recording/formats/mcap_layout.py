"""Where in an MCAP file are its messages, and on which topics?"""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator
from io import BytesIO
from typing import BinaryIO
from zlib import crc32

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Schema, Statistics

from tracker.recording.formats.blocks import Block, Run
from tracker.recording.formats.walk import RecordWalk

HEAD = struct.Struct("<BQ")  # opcode, length
MESSAGE = struct.Struct("<HIQQ")  # channel, sequence, log time, publish time
_CHUNK = struct.Struct("<QQQII")  # first, last log time, unpacked size, checksum, name's length
_INDEX = struct.Struct("<HI")  # channel, length of the entries
_FOOTER = struct.Struct("<QQI")  # offsets of the summary, and of its parts; checksum

_SMALLEST = {Opcode.MESSAGE: 22, Opcode.CHUNK: 40, Opcode.SCHEMA: 14, Opcode.CHANNEL: 16}
_SIZES = {Opcode.DATA_END: 4, Opcode.FOOTER: 20}
_CANDIDATE = re.compile(rb"(?=[\x01-\x0f].{5}\x00\x00\x00|\x89MCAP0\r\n)", re.DOTALL)

#: Bytes looked at of each record, the largest definition, and the largest summary.
_PEEK, _DEFINITION, _LARGEST_SUMMARY = 80, 1 << 24, 1 << 28


class McapLayout(RecordWalk):
    """What a walk over an MCAP file finds.

    Attributes:
        blocks: In the file's order.
        schemas: Type names, by number.
        channels: By number.
        statistics: What the file says of itself at its end, if anything.
        is_finished: The file has its end.
        indexed: Messages counted by the indexes behind the chunks.
    """

    magic = b"\x89MCAP0\r\n"

    def __init__(self, file: BinaryIO) -> None:
        super().__init__(file)
        self.blocks: list[Block] = []
        self.schemas: dict[int, str] = {}
        self.channels: dict[int, Channel] = {}
        self.statistics: Statistics | None = None
        self.is_finished = False
        self.indexed = 0
        self._run = Run(self.blocks)
        self._summary: int | None = None  # where it begins
        self._before: tuple[dict[int, str], dict[int, Channel]] = ({}, {})
        self.run()
        self._run.end()

    def define(self, opcode: int, body: bytes) -> None:
        """Take in a schema, a channel or statistics; one that makes no sense is passed over."""
        stream = ReadDataStream(BytesIO(body))
        try:
            if opcode == Opcode.SCHEMA:
                schema = Schema.read(stream)
                self.schemas[schema.id] = schema.name
            elif opcode == Opcode.CHANNEL:
                channel = Channel.read(stream)
                self.channels[channel.id] = channel
            elif opcode == Opcode.STATISTICS:
                self.statistics = Statistics.read(stream)
        except (McapError, struct.error, UnicodeDecodeError):
            return

    def take(self, offset: int, end: int) -> None:
        """As `RecordWalk.take`."""
        opcode, *_ = head = self.at(offset, _PEEK)
        body = head[HEAD.size :]
        if opcode == Opcode.MESSAGE:
            self._run.add(offset, end, MESSAGE.unpack_from(body)[2])
        elif opcode in (Opcode.SCHEMA, Opcode.CHANNEL, Opcode.STATISTICS):
            if end - offset <= _DEFINITION:
                self.define(opcode, self.at(offset + HEAD.size, end - offset - HEAD.size))
        elif opcode == Opcode.CHUNK:
            self._take_chunk(offset, end, body)
        elif opcode == Opcode.MESSAGE_INDEX and self.blocks:
            channel, length = _INDEX.unpack_from(body)
            self.indexed += length // 16
            known = self.blocks[-1].channels or frozenset()
            self.blocks[-1] = self.blocks[-1]._replace(channels=known | {channel})
        elif opcode == Opcode.DATA_END:
            self._before = (dict(self.schemas), dict(self.channels))
            self._summary = end
        elif opcode == Opcode.FOOTER:
            self.is_finished = True
            self._check_summary(offset, end)

    def lose(self) -> None:
        """As `RecordWalk.lose`."""
        self._run.end()

    def end_of(self, offset: int) -> int | None:
        """As `RecordWalk.end_of`."""
        head = self.at(offset, _PEEK)
        if len(head) < HEAD.size:
            return None
        opcode, length = HEAD.unpack_from(head)
        end, body = offset + HEAD.size + length, head[HEAD.size :]
        is_known = 0 < opcode <= Opcode.DATA_END or opcode >= 0x80
        if end > self.size or not is_known or length < _SMALLEST.get(opcode, 0):
            return None
        if length != _SIZES.get(opcode, length):
            return None
        if opcode == Opcode.CHUNK and not _is_chunk(body, length):
            return None
        if opcode == Opcode.MESSAGE_INDEX and not _is_index(body, length):
            return None
        return int(end)

    def candidates(self, window: bytes) -> Iterator[int]:
        """As `RecordWalk.candidates`."""
        for match in _CANDIDATE.finditer(window):
            yield match.start()

    def _take_chunk(self, offset: int, end: int, body: bytes) -> None:
        self._run.end()
        first, last, size, checksum, length = _CHUNK.unpack_from(body)
        name = body[_CHUNK.size : _CHUNK.size + length].decode("ascii", "replace")
        data = offset + HEAD.size + 40 + length
        self.blocks.append(Block(data, end - data, first, last, name, size, checksum))

    def _check_summary(self, footer: int, end: int) -> None:
        """Forget what the file says at its end if the checksum of that is wrong."""
        *_, checksum = _FOOTER.unpack(self.at(end - _FOOTER.size, _FOOTER.size))
        if self._summary is None or not checksum:
            return
        size = end - 4 - self._summary
        if size > _LARGEST_SUMMARY or crc32(self.at(self._summary, size)) != checksum:
            self.damages.append(footer)
            self.statistics = None
            self.schemas, self.channels = self._before


def _is_chunk(body: bytes, length: int) -> bool:
    name = _CHUNK.unpack_from(body)[4]
    if name > _PEEK - HEAD.size - 40:
        return False
    (data,) = struct.unpack_from("<Q", body, _CHUNK.size + name)
    return bool(length == 40 + name + data)


def _is_index(body: bytes, length: int) -> bool:
    entries = _INDEX.unpack_from(body)[1] if length >= _INDEX.size else 1
    return bool(length == _INDEX.size + entries and entries % 16 == 0)
