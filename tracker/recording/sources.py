"""What is a recording made of, whatever the file? Raw messages on topics, in log-time order."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

from tracker.errors import RecordingError
from tracker.messages import Event


@dataclass(frozen=True, slots=True)
class TopicInfo:
    """What is known of a topic before it is read.

    Attributes:
        type_name: `package/msg/Name`.
        count: How many messages it holds, as far as the file says.
    """

    type_name: str
    count: int


class RawMessage(NamedTuple):
    """One message as it lies in the file.

    Attributes:
        topic: Where it was published.
        type_name: `package/msg/Name`.
        log_ns: When it was recorded.
        data: What the source that made it understands.
    """

    topic: str
    type_name: str
    log_ns: int
    data: Any


class Source(Protocol):
    """A file, or several, that holds messages."""

    #: What the user would call it.
    kind: str
    topics: dict[str, TopicInfo]
    #: Log time of the first message, and of the last.
    start_ns: int
    end_ns: int
    #: What was odd about the files, as sentences.
    notes: list[str]

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        """The messages of some topics in log-time order, from the beginning.

        Raises:
            RecordingError: The file is damaged; everything before the damage has been yielded.
        """

    def read(self, message: RawMessage, *, is_static: bool, max_pixels: int) -> list[Event]:
        """What one message says; pictures of up to `max_pixels`.

        Raises:
            TrackerError: Nothing that makes sense.
        """

    def close(self) -> None:
        """Let go of the files."""


class Row:
    """Several sources one after the other: the parts of one recording."""

    def __init__(self, kind: str, parts: list[Source], notes: list[str]) -> None:
        self.kind = kind
        self._parts = parts
        self.notes = notes + [note for part in parts for note in part.notes]
        self.topics: dict[str, TopicInfo] = {}
        for part in parts:
            for topic, info in part.topics.items():
                before = self.topics[topic].count if topic in self.topics else 0
                self.topics[topic] = TopicInfo(info.type_name, before + info.count)
        filled = [part for part in parts if part.topics]
        self.start_ns = min((part.start_ns for part in filled), default=0)
        self.end_ns = max((part.end_ns for part in filled), default=0)

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        """As `Source.messages`."""
        for part in self._parts:
            yield from part.messages(topics)

    def read(self, message: RawMessage, *, is_static: bool, max_pixels: int) -> list[Event]:
        """As `Source.read`; the parts are of one kind."""
        return self._parts[0].read(message, is_static=is_static, max_pixels=max_pixels)

    def close(self) -> None:
        """As `Source.close`."""
        for part in self._parts:
            part.close()


def seconds_into(log_ns: int, start_ns: int) -> str:
    """A log time for a message to the user: since the recording's beginning."""
    return f"{(log_ns - start_ns) / 1e9:.3f} s"


def unreadable(path: object, reason: object, remedy: str) -> RecordingError:
    """The one line for a file that cannot be opened."""
    return RecordingError(f"{path}: cannot be read ({str(reason).rstrip('.')}). {remedy}")
