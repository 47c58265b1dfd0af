"""What is left of an MCAP file whose end is missing? Everything up to the cut, read in a row.

A recorder that was killed leaves no index. The records themselves are whole up to there.
"""

from __future__ import annotations

import struct
from collections.abc import Collection, Iterator
from pathlib import Path

from mcap.exceptions import McapError
from mcap.records import Channel, Chunk, McapRecord, Message, Schema
from mcap.stream_reader import CRCValidationError, StreamReader, breakup_chunk
from zstandard import ZstdError

from tracker.errors import RecordingError
from tracker.messages import Event, decode
from tracker.recording.sources import RawMessage, TopicInfo, seconds_into, unreadable

#: What the reader and the decompressors raise at a cut or a damaged place.
_DAMAGED = (
    McapError,
    CRCValidationError,
    ZstdError,
    RuntimeError,
    struct.error,
    ValueError,
    OSError,
)


class CutMcapSource:
    """An .mcap file without its end.

    Messages come in the file's order, and in log-time order within each chunk.

    Args:
        path: The file.
        reason: Why it could not be read as a whole.

    Raises:
        RecordingError: Not even its beginning can be read.
    """

    kind = "ROS 2 recording"

    def __init__(self, path: Path, reason: str) -> None:
        self._path = path
        self._reason = reason.rstrip(".")
        self.start_ns = self.end_ns = 0
        counts: dict[tuple[str, str], int] = {}
        times: list[int] = []
        try:
            for message in self._stream():
                key = (message.topic, message.type_name)
                counts[key] = counts.get(key, 0) + 1
                times = [min([*times[:1], message.log_ns]), max([*times[1:], message.log_ns])]
            damage = ""
        except _DAMAGED as error:
            damage = f" ({error})" if str(error) else ""
        if not counts:
            raise unreadable(path, f"{self._reason}{damage}", "Nothing of it is left.")
        self.start_ns, self.end_ns = times
        self.topics = {topic: TopicInfo(kind, count) for (topic, kind), count in counts.items()}
        self.notes = [
            f"{path}: is incomplete or has no index ({self._reason}); read from its beginning."
        ]

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        """As `Source.messages`."""
        log_ns = self.start_ns
        stream = self._stream()
        while True:
            try:
                message = next(stream)
            except StopIteration:
                return
            except _DAMAGED as error:
                raise RecordingError(
                    f"{self._path}: ends or breaks {seconds_into(log_ns, self.start_ns)} after "
                    f"its beginning ({self._reason}). What came before was read."
                ) from error
            log_ns = max(log_ns, message.log_ns)
            if message.topic in topics:
                yield message

    def read(self, message: RawMessage, *, is_static: bool, max_pixels: int) -> list[Event]:
        """As `Source.read`."""
        return decode(message.type_name, message.data, is_static=is_static, max_pixels=max_pixels)

    def close(self) -> None:
        """Nothing stays open between calls."""

    def _stream(self) -> Iterator[RawMessage]:
        types: dict[int, str] = {}
        channels: dict[int, Channel] = {}
        with self._path.open("rb") as file:
            for record in StreamReader(file, emit_chunks=True).records:
                for part in _parts(record):
                    if isinstance(part, Schema):
                        types[part.id] = part.name
                    elif isinstance(part, Channel):
                        channels[part.id] = part
                    elif isinstance(part, Message) and part.channel_id in channels:
                        channel = channels[part.channel_id]
                        yield RawMessage(
                            channel.topic,
                            types.get(channel.schema_id, ""),
                            part.log_time,
                            part.data,
                        )


def _parts(record: McapRecord) -> list[McapRecord]:
    if not isinstance(record, Chunk):
        return [record]
    parts = breakup_chunk(record, validate_crc=True)
    return sorted(parts, key=lambda part: part.log_time if isinstance(part, Message) else 0)
