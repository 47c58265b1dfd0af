"""How are MCAP files read? Block by block in log-time order, whatever index they have or lack."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator
from pathlib import Path
from zlib import crc32

from mcap.opcode import Opcode

from tracker.recording.formats.blocks import Block, Part, check_count, damage_of, in_order, placed
from tracker.recording.formats.mcap_layout import HEAD, MESSAGE, McapLayout
from tracker.recording.formats.unpacking import DamagedError, unpack, unpack_message
from tracker.recording.sources import RawMessage, TopicInfo, open_bytes, topics_of, unreadable

#: A log time beyond it is damage; recorders count in signed numbers.
_LATEST_NS = 2**63 - 1


class McapSource:
    """An .mcap file: whole, without indexes, without its end, or damaged.

    Args:
        path: The file.

    Raises:
        RecordingError: Nothing of it can be read.
    """

    kind = "ROS 2 recording"

    def __init__(self, path: Path) -> None:
        self._path = path
        self.notes: list[str] = []
        self._file = open_bytes(path)
        self._layout = layout = McapLayout(self._file)
        counts = self._count()
        if not (layout.is_finished or any(counts.values())):
            self._file.close()
            reason = "it is cut off or damaged before its first message"
            if not layout.size:
                reason = "it seems to be empty"
            raise unreadable(path, reason, "Is it an MCAP file of ROS 2 messages?")
        self.topics: dict[str, TopicInfo] = topics_of(
            (*self._named(key), count) for key, count in counts.items()
        )
        self.start_ns, self.end_ns = self._extent()
        self._placed = placed(layout.blocks, self.start_ns, self.end_ns)

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        """As `Source.messages`."""
        wanted = {key for key, item in self._layout.channels.items() if item.topic in topics}
        layout, read = self._layout, Counter[str]()
        damage = damage_of(
            layout.damages, layout.is_finished, self._placed, self.start_ns, self.end_ns
        )
        for part in in_order(self._blocks(wanted), self._parts, damage):
            if part.channel not in wanted:
                if part.channel not in self._layout.channels:
                    damage.add(part.log_ns, "a message belongs to no known topic")
                continue
            try:
                data = unpack_message(part.data)
            except DamagedError as error:
                damage.add(part.log_ns, str(error))
                continue
            topic, type_name = self._named(part.channel)
            read[topic] += 1
            yield RawMessage(topic, type_name, part.log_ns, data)
        counted = {topic: info.count for topic, info in self.topics.items() if topic in topics}
        damage.tell(self._path, self.start_ns, counted, read)

    def close(self) -> None:
        """As `Source.close`."""
        self._file.close()

    def _named(self, channel: int) -> tuple[str, str]:
        item = self._layout.channels[channel]
        return item.topic, self._layout.schemas.get(item.schema_id, "")

    def _count(self) -> dict[int, int]:
        """Messages of each channel: by the file's own statistics, or else by reading them all."""
        layout, said = self._layout, self._layout.statistics
        counts = {} if said is None else said.channel_message_counts
        if said is None or layout.damages or not set(counts) <= set(layout.channels):
            found = Counter[int]()
            for block in layout.blocks:
                try:
                    found.update(part.channel for part in self._parts(block))
                except DamagedError:
                    continue
            counts = {**found, **counts}
        return {key: counts.get(key, 0) for key in layout.channels}

    def _extent(self) -> tuple[int, int]:
        """First and last log time."""
        said = self._layout.statistics
        if said is not None and said.message_count:
            return said.message_start_time, said.message_end_time
        filled = [
            block
            for block in self._layout.blocks
            if block.unpacked_size and block.start_ns <= block.end_ns <= _LATEST_NS
        ]
        first = min((block.start_ns for block in filled), default=0)
        return first, max((block.end_ns for block in filled), default=0)

    def _blocks(self, wanted: set[int]) -> list[Block]:
        """Those that may hold a wanted message; the indexes are trusted if they count right."""
        said = self._layout.statistics
        if said is None or self._layout.damages or said.message_count != self._layout.indexed:
            return self._placed
        return [
            block for block in self._placed if block.channels is None or block.channels & wanted
        ]

    def _parts(self, block: Block) -> list[Part]:
        """The messages of a block; what it defines goes into the layout.

        Raises:
            DamagedError: It does not hold what it says.
        """
        self._file.seek(block.offset)
        packed = self._file.read(block.size)
        data = unpack(packed, block.compression, block.unpacked_size)
        if block.checksum and crc32(data) != block.checksum:
            raise DamagedError("the checksum of a chunk is wrong")
        view, end, count, found = memoryview(data), 0, 0, []
        while end + HEAD.size <= len(data):
            opcode, length = HEAD.unpack_from(data, end)
            if not opcode:
                raise DamagedError("a chunk contains something that is not a record")
            check_count(count := count + 1)
            body = end + HEAD.size
            end = body + length
            if end > len(data):
                break
            if opcode == Opcode.MESSAGE and length >= MESSAGE.size:
                channel, _, log_ns, _ = MESSAGE.unpack_from(data, body)
                if log_ns <= _LATEST_NS:
                    found.append(Part(log_ns, channel, view[body + MESSAGE.size : end]))
            elif opcode in (Opcode.SCHEMA, Opcode.CHANNEL):
                self._layout.define(opcode, data[body:end])
        return found
