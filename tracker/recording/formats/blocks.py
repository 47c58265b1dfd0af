"""How are messages in blocks sorted by time, with few blocks in memory?"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from heapq import heappop, heappush
from typing import NamedTuple

from tracker.recording.formats.damage import Damage
from tracker.recording.formats.unpacking import LARGEST_BYTES, DamagedError

#: What a block's records may come to; recorders' chunks have some thousands at most.
_MOST_RECORDS = 500_000


class Block(NamedTuple):
    """A piece of a file with messages: a chunk, or a run of messages outside any.

    Attributes:
        offset: Of its first byte in the file.
        size: Bytes in the file.
        start_ns: Earliest log time, as far as the file says.
        end_ns: Latest.
        compression: As for `unpack`.
        unpacked_size: Bytes when unpacked.
        checksum: CRC-32 of those; 0 is none.
        channels: Those with messages in it; None where that is not known.
    """

    offset: int
    size: int
    start_ns: int
    end_ns: int
    compression: str
    unpacked_size: int
    checksum: int = 0
    channels: frozenset[int] | None = None


class Part(NamedTuple):
    """A message of a block.

    Attributes:
        log_ns: When it was recorded.
        channel: On which channel or connection.
        data: Its bytes.
    """

    log_ns: int
    channel: int
    data: memoryview


class Run:
    """Gathers messages that lie outside chunks into blocks.

    Args:
        blocks: Where these go.
    """

    _LARGEST_BYTES = 1 << 22

    def __init__(self, blocks: list[Block]) -> None:
        self._blocks = blocks
        self._now: tuple[int, int, int, int] | None = None

    def add(self, offset: int, end: int, log_ns: int) -> None:
        """A message follows the last one."""
        begin, _, first, last = self._now or (offset, end, log_ns, log_ns)
        self._now = (begin, end, min(first, log_ns), max(last, log_ns))
        if end - begin > self._LARGEST_BYTES:
            self.end()

    def end(self) -> None:
        """What comes next does not follow."""
        if self._now is not None:
            offset, end, first, last = self._now
            self._blocks.append(Block(offset, end - offset, first, last, "", end - offset))
            self._now = None


def check_count(count: int) -> None:
    """Refuse a block of more records than any has that a recorder wrote.

    Raises:
        DamagedError: There are so many.
    """
    if count > _MOST_RECORDS:
        raise DamagedError(f"a chunk holds more than {_MOST_RECORDS} records")


def placed(blocks: list[Block], first_ns: int, last_ns: int) -> list[Block]:
    """Blocks in the order of their first messages.

    Args:
        blocks: In the file's order. One whose times are nonsense keeps its place there.
        first_ns: First log time of the recording.
        last_ns: Last.
    """
    rows, before_ns = [], first_ns
    for block in blocks:
        if first_ns <= block.start_ns <= block.end_ns <= last_ns:
            before_ns = block.start_ns
        rows.append((before_ns, block.offset, block._replace(start_ns=before_ns)))
    return [block for _, _, block in sorted(rows, key=lambda row: row[:2])]


def damage_of(
    lost_at: list[int], is_finished: bool, blocks: list[Block], first_ns: int, last_ns: int
) -> Damage:
    """What a walk over the file has found out already.

    Args:
        lost_at: Offsets of records that make no sense.
        is_finished: The file has its end.
        blocks: From `placed`.
        first_ns: First log time of the recording.
        last_ns: Last.
    """
    damage = Damage()
    for offset in lost_at:
        before = [block.end_ns for block in blocks if block.offset < offset]
        damage.add(max(before, default=first_ns), "records are damaged")
    if not is_finished:
        damage.cut(last_ns)
    return damage


def in_order(
    blocks: list[Block], parts_of: Callable[[Block], list[Part]], damage: Damage
) -> Iterator[Part]:
    """The messages by log time.

    Args:
        blocks: From `placed`.
        parts_of: Reads a block, or raises DamagedError.
        damage: Told of blocks that cannot be read.
    """
    heap: list[tuple[int, int, int]] = []
    opened: dict[int, list[Part]] = {}

    def pop() -> Part:
        _, number, row = heappop(heap)
        part = opened[number][row]
        if row + 1 < len(opened[number]):
            heappush(heap, (opened[number][row + 1].log_ns, number, row + 1))
        else:
            del opened[number]
        return part

    for number, block in enumerate(blocks):
        while heap and (
            heap[0][0] < block.start_ns
            or sum(blocks[key].unpacked_size for key in opened) > LARGEST_BYTES
        ):
            yield pop()
        try:
            parts = sorted(parts_of(block), key=lambda part: part.log_ns)
        except DamagedError as error:
            damage.add(block.start_ns, str(error))
            continue
        if parts:
            opened[number] = parts
            heappush(heap, (parts[0].log_ns, number, 0))
    while heap:
        yield pop()
