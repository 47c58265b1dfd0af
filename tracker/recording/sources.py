"""What is a recording made of, whatever the file? Raw messages on topics, in log-time order."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple, Protocol

from tracker.errors import RecordingError
from tracker.messages import Event, decode


@dataclass(frozen=True, slots=True)
class TopicInfo:
    """What is known of a topic before it is read.

    Attributes:
        type_name: `package/msg/Name`.
        count: How many messages it holds, as far as the file says.
    """

    type_name: str
    count: int


class Reading(NamedTuple):
    """How messages are read.

    Attributes:
        max_pixels: Larger pictures are refused.
        is_static: Transforms last.
        is_depth: Pictures hold depths.
    """

    max_pixels: int
    is_static: bool = False
    is_depth: bool = False


class RawMessage(NamedTuple):
    """One message as it lies in the file.

    Attributes:
        topic: Where it was published.
        type_name: `package/msg/Name`.
        log_ns: When it was recorded.
        data: What `reader` understands.
        reader: Of this kind of file; by default of ROS 2's.
    """

    topic: str
    type_name: str
    log_ns: int
    data: Any
    reader: Callable[[RawMessage, Reading], list[Event]] = lambda message, how: decode(
        message.type_name, message.data, **how._asdict()
    )

    def read(self, how: Reading) -> list[Event]:
        """What it says.

        Raises:
            TrackerError: Nothing that makes sense.
        """
        return self.reader(self, how)


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
            RecordingError: The file is damaged; everything that can be read has been yielded.
        """

    def close(self) -> None:
        """Let go of the files."""


class Row:
    """Several sources one after the other: the parts of one recording.

    Args:
        kind: What the user would call it.
        parts: In the order of recording.
        notes: What was odd about the whole, as sentences.
        broken: What is wrong with parts that are left out, as sentences.
    """

    def __init__(
        self, kind: str, parts: list[Source], notes: list[str], broken: Sequence[str] = ()
    ) -> None:
        self.kind = kind
        self._parts, self._broken = parts, broken
        self.notes = notes + [note for part in parts for note in part.notes]
        self.topics = topics_of(
            (topic, info.type_name, info.count)
            for part in parts
            for topic, info in part.topics.items()
        )
        filled = [part for part in parts if part.topics]
        self.start_ns = min((part.start_ns for part in filled), default=0)
        self.end_ns = max((part.end_ns for part in filled), default=0)

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        """As `Source.messages`; damage to one part leaves the others to be read."""
        errors = [*self._broken]
        for part in self._parts:
            try:
                yield from part.messages(topics)
            except RecordingError as error:
                errors.append(str(error))
        if errors:
            more = f" ... and {len(errors) - 1} more of its files" if errors[1:] else ""
            raise RecordingError(errors[0] + more)

    def close(self) -> None:
        """As `Source.close`."""
        for part in self._parts:
            part.close()


class WrappedSource:
    """A source that lies in a temporary file; told under its own name.

    Args:
        source: What is read.
        place: Where it lies.
        name: What the user calls it.
        opened: What ends with it.
    """

    def __init__(self, source: Source, place: Path, name: Path, opened: ExitStack) -> None:
        self._source, self._opened = source, opened
        self._place, self._name = str(place), str(name)
        self.kind, self.topics = source.kind, source.topics
        self.notes = [note.replace(self._place, self._name) for note in source.notes]
        self.start_ns, self.end_ns = source.start_ns, source.end_ns

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        """As `Source.messages`."""
        try:
            yield from self._source.messages(topics)
        except RecordingError as error:
            raise RecordingError(str(error).replace(self._place, self._name)) from error

    def close(self) -> None:
        """As `Source.close`."""
        self._opened.close()


def topics_of(rows: Iterable[tuple[str, str, int]]) -> dict[str, TopicInfo]:
    """Topics by name from (name, type, count) of each channel or file; counts add up."""
    topics: dict[str, TopicInfo] = {}
    for topic, type_name, count in rows:
        before = topics.get(topic, TopicInfo(type_name, 0))
        same = before.type_name == type_name
        topics[topic] = TopicInfo(type_name if same else "several types", before.count + count)
    return topics


def seconds_into(log_ns: int, start_ns: int) -> str:
    """A log time for a message to the user: since the recording's beginning."""
    return f"{(log_ns - start_ns) / 1e9:.3f} s"


def open_bytes(path: Path) -> BinaryIO:
    """A file to be read from.

    Raises:
        RecordingError: It cannot be opened.
    """
    try:
        return path.open("rb")
    except OSError as error:
        raise unreadable(path, error.strerror, "Check its rights.") from error


def unreadable(path: object, reason: object, remedy: str) -> RecordingError:
    """The one line for a file that cannot be opened."""
    return RecordingError(f"{path}: cannot be read ({str(reason).rstrip('.')}). {remedy}")
