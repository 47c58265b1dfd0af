"""How are ROS 1 bags read? Block by block in log-time order, with an index or without."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator
from functools import lru_cache
from pathlib import Path

from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from tracker.errors import RecordingError
from tracker.messages import Event, events_from_message
from tracker.messages.types import MALFORMED, TF_MESSAGE, TF_MESSAGE_ROS1
from tracker.recording.formats.blocks import Block, Part, check_count, damage_of, in_order, placed
from tracker.recording.formats.ros1_layout import Ros1Layout, read_record
from tracker.recording.formats.unpacking import DamagedError, unpack
from tracker.recording.sources import RawMessage, Reading, open_bytes, topics_of, unreadable

_REMEDY = "Is it a ROS 1 bag? If its recording was cut off, repair it with `rosbag reindex`."
_MESSAGE, _CONNECTION = 2, 7


class Ros1Source:
    """A ROS 1 .bag file: whole, without its index (`.bag.active`), cut off or damaged.

    Args:
        path: The file.

    Raises:
        RecordingError: Nothing of it can be read.
    """

    kind = "ROS 1 bag"

    def __init__(self, path: Path) -> None:
        self._path = path
        self.notes: list[str] = []
        self._file = open_bytes(path)
        self._layout = Ros1Layout(self._file)
        self._blocks, counts = self._look_through()
        is_bag = self._layout.at(0, len(self._layout.magic)) == self._layout.magic
        if not self._blocks and not (is_bag and self._layout.connections):
            self._file.close()
            reason = "no message in it" if self._layout.size else "it is empty"
            raise unreadable(path, reason, _REMEDY)
        named = self._layout.connections
        self.topics = topics_of((*named[key], counts.get(key, 0)) for key in named)
        self.start_ns = min((block.start_ns for block in self._blocks), default=0)
        self.end_ns = max((block.end_ns for block in self._blocks), default=0)
        self._blocks = placed(self._blocks, self.start_ns, self.end_ns)

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        """As `Source.messages`."""
        layout = self._layout
        wanted = {key for key, (topic, _) in layout.connections.items() if topic in topics}
        read = Counter[str]()
        damage = damage_of(
            layout.damages, layout.is_finished, self._blocks, self.start_ns, self.end_ns
        )
        blocks = [
            block for block in self._blocks if block.channels is None or block.channels & wanted
        ]
        for part in in_order(blocks, self._parts, damage):
            if part.channel in wanted:
                topic, type_name = layout.connections[part.channel]
                read[topic] += 1
                yield RawMessage(topic, type_name, part.log_ns, bytes(part.data), _read)
        counted = {topic: info.count for topic, info in self.topics.items() if topic in topics}
        damage.tell(self._path, self.start_ns, counted, read)

    def close(self) -> None:
        """As `Source.close`."""
        self._file.close()

    def _look_through(self) -> tuple[list[Block], dict[int, int]]:
        """Blocks with their times, and messages of each connection; unpacked where not indexed."""
        layout = self._layout
        if layout.is_finished and layout.is_indexed and not layout.damages:
            return layout.blocks, layout.counts
        found: list[Block] = []
        counts = Counter[int]()
        for block in layout.blocks:
            try:
                parts = self._parts(block)
            except DamagedError:
                parts = []
            counts.update(part.channel for part in parts)
            if parts:
                times = [part.log_ns for part in parts]
                block = block._replace(start_ns=min(times), end_ns=max(times), channels=None)
            elif block.start_ns < 0:
                before_ns = found[-1].end_ns if found else 0
                block = block._replace(start_ns=before_ns, end_ns=before_ns)
            found.append(block)
        return found, {key: max(counts[key], layout.counts.get(key, 0)) for key in counts}

    def _parts(self, block: Block) -> list[Part]:
        """The messages of a block; connections in it go into the layout.

        Raises:
            DamagedError: It does not hold what it says.
        """
        self._file.seek(block.offset)
        data = unpack(self._file.read(block.size), block.compression, block.unpacked_size)
        found: list[Part] = []
        view, offset = memoryview(data), 0
        while (record := read_record(data, offset)) is not None:
            check_count(len(found))
            begin, offset = offset + record.data, offset + record.end
            if offset > len(data):
                break
            if record.opcode == _MESSAGE and record.log_ns >= 0:
                found.append(Part(record.log_ns, record.number(b"conn"), view[begin:offset]))
            elif record.opcode == _CONNECTION:
                self._layout.define(record, data[begin:offset])
        if data and not offset:
            raise DamagedError("a chunk holds no records")
        return found


def _read(message: RawMessage, how: Reading) -> list[Event]:
    try:
        said = _typestore().deserialize_ros1(message.data, message.type_name)
    except MALFORMED as error:
        raise RecordingError(
            f"{len(message.data)} bytes came as ROS 1 {message.type_name}; they do not hold "
            f"one ({error})."
        ) from error
    return events_from_message(message.type_name, said, **how._asdict())


@lru_cache(maxsize=1)
def _typestore() -> Typestore:
    store = get_typestore(Stores.ROS1_NOETIC)
    for name in (TF_MESSAGE, TF_MESSAGE_ROS1):
        definition = "geometry_msgs/TransformStamped[] transforms\n"
        store.register(get_types_from_msg(definition, name))
    return store
