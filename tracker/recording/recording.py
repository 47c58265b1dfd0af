"""What did the robot see? One stream of sensor data from any recording, video or photos."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median

from tracker.camera import CameraModel, DepthCamera
from tracker.closing import Closing
from tracker.containers import CameraImage, Scan
from tracker.errors import RecordingError, TrackerError
from tracker.messages import DECODABLE, Event, types
from tracker.messages.picture_size import MAX_PIXELS
from tracker.recording.sources import RawMessage, Reading, Source, TopicInfo, seconds_into
from tracker.recording.topics import IMAGES, TRANSFORMS, Topics, TopicTable
from tracker.wording import listing, one_line

#: Messages whose stamps are compared with the log's time, and the offset that is worth a word.
_STAMPS_COMPARED, _WORTH_A_WORD_S = 10, 1.0

_PICTURES = ("video frames", "photos")


#: ROS's stamps hold 31 bits of seconds.
_TOO_LATE_NS = 2**31 * 1_000_000_000


@dataclass(frozen=True, slots=True)
class Summary:
    """What a recording says of itself.

    Attributes:
        kind: "ROS 2 recording", "ROS 1 bag", "video" or "photos".
        start_ns: Log time of the first message.
        duration_s: From the first message to the last.
        topics: Type and number of messages of every topic, used or not.
    """

    kind: str
    start_ns: int
    duration_s: float
    topics: dict[str, TopicInfo]


@dataclass(slots=True)
class Skipped:
    """Messages of one topic that could not be used.

    Attributes:
        count: How many.
        first: When the first of them came, and what was wrong with it.
    """

    count: int
    first: str


class Recording(Closing):
    """Sensor data in log-time order; a context manager. Made by `open_recording`.

    Attributes:
        path: Where it lies.
        summary: What it holds.
        topics: Type and number of messages of every topic it holds, used or not.
        read_topics: The topics that are really read.
        notes: What a user should know about it, as sentences.
        skipped: Messages that could not be used, by topic; filled while `events` runs.
    """

    def __init__(
        self,
        path: Path,
        source: Source,
        topics: Topics,
        *,
        with_truth: bool,
        stamps: str,
        max_pixels: int = MAX_PIXELS,
    ) -> None:
        if stamps not in ("header", "log"):
            raise RecordingError(f"stamps={stamps!r} was given; expected header or log.")
        self.path = path
        self.skipped: dict[str, Skipped] = {}
        self._source = source
        self._stamps = stamps
        self._max_pixels = max_pixels
        self._with_truth = with_truth
        duration_s = (source.end_ns - source.start_ns) / 1e9
        self.summary = Summary(source.kind, source.start_ns, duration_s, dict(source.topics))
        self._asked = topics
        self.notes = list(source.notes)
        self.topics = self.summary.topics
        self._table = TopicTable(self.topics)
        self.read_topics = self._find_topics(topics)
        self._note_stamps()

    def close(self) -> None:
        """Let go of the files."""
        self._source.close()

    @property
    def has_images(self) -> bool:
        """Pictures are on the image topic."""
        return self._table.holds(self.read_topics.image, *IMAGES, *_PICTURES)

    @property
    def image_topics(self) -> list[str]:
        """Every topic with pictures, whether it is the one asked for or not."""
        return self._table.of_type(*IMAGES)

    @property
    def has_scans(self) -> bool:
        """Scans are on the scan topic."""
        return self._table.holds(self.read_topics.scan, types.LASER_SCAN)

    @property
    def has_depth(self) -> bool:
        """Depth images are on the depth topic."""
        return self._table.holds(self.read_topics.depth, *IMAGES)

    @property
    def has_camera_info(self) -> bool:
        """Intrinsics are on the camera_info topic."""
        return self._table.holds(self.read_topics.camera_info, types.CAMERA_INFO)

    @property
    def has_transforms(self) -> bool:
        """Transforms are on one of their topics."""
        names = (self.read_topics.tf, self.read_topics.tf_static)
        return any(self._table.holds(name, *TRANSFORMS) for name in names)

    @property
    def has_map(self) -> bool:
        """A map of the room is on the map topic."""
        return self._table.holds(self.read_topics.map, types.OCCUPANCY_GRID)

    @property
    def has_truth(self) -> bool:
        """Simulated people are on the truth topic."""
        return self._table.holds(self.read_topics.truth, types.DETECTIONS)

    @property
    def is_bag(self) -> bool:
        """It comes from a robot: not a video, nor photos."""
        return self.summary.kind not in ("video", "photos")

    def share(self, log_ns: int) -> float:
        """How far into the recording a log time is, from 0 to 1."""
        length_ns = self._source.end_ns - self._source.start_ns
        since_ns = log_ns - self._source.start_ns
        return min(max(since_ns / length_ns, 0.0), 1.0) if length_ns else 1.0

    def skipped_lines(self) -> list[str]:
        """One sentence for each topic of which something could not be used."""
        return [
            f"{one_line(topic)}: {skipped.count} unusable messages, the first: {skipped.first}"
            for topic, skipped in sorted(self.skipped.items())
        ]

    def require_images(self) -> None:
        """Insist on pictures.

        Raises:
            RecordingError: There are none on the image topic; the message says where there are.
        """
        if self.has_images:
            return
        holding = self.image_topics
        remedy = (
            f"Pass --image-topic {listing(holding)}"
            if len(holding) == 1
            else f"Pass --image-topic with one of {listing(holding)}"
            if holding
            else "A recording with images is needed"
        )
        raise RecordingError(
            f"{self.path}: no images on {one_line(self._asked.image)}; the recording contains "
            f"{self._table.described() or 'nothing'}. {remedy}."
        )

    def unread_lines(self) -> list[str]:
        """What a sensor recorded that is not read, and what to do: a line for each."""
        lines = (
            self._table.unread_scans(self.read_topics.scan),
            self._table.unread_transforms(self.read_topics),
        )
        return [line for line in lines if line]

    def events(self) -> Iterator[tuple[int, Event]]:
        """Everything the sensors said, from the beginning, with constant memory.

        Lasting transforms come first, wherever they lie in the recording. A message that cannot be
        used is counted in `skipped`.

        Yields:
            Log time in nanoseconds, and what was said. Stamps are the messages' own, or the log
            time where `stamps="log"`.

        Raises:
            RecordingError: The file is damaged; what comes before the damage has been yielded.
        """
        self.skipped.clear()
        for event in self._lasting():
            yield self._source.start_ns, event
        moving = self._used() - {self.read_topics.tf_static}
        for message in self._source.messages(moving):
            for event in self._read(message):
                yield message.log_ns, event

    def _lasting(self) -> list[Event]:
        found: list[Event] = []
        if self._table.holds(self.read_topics.tf_static, *TRANSFORMS):
            try:
                for message in self._source.messages({self.read_topics.tf_static}):
                    found += self._read(message, is_static=True)
            except RecordingError:  # the same damage ends `events` later on, and is told then
                pass
        return found

    def _read(self, message: RawMessage, *, is_static: bool = False) -> list[Event]:
        try:
            events = message.read(
                Reading(self._max_pixels, is_static, self._is_of_depth(message.topic))
            )
        except TrackerError as error:
            self._skip(message, str(error))
            return []
        if self._stamps == "log":
            events = [_restamped(event, message.log_ns) for event in events]
        usable = [event for event in events if _is_in_time(event)]
        if len(usable) < len(events):
            self._skip(message, "its stamp is after 2038, which ROS cannot represent")
        return usable

    def _skip(self, message: RawMessage, why: str) -> None:
        if message.topic in self.skipped:
            self.skipped[message.topic].count += 1
        else:
            when = seconds_into(message.log_ns, self._source.start_ns)
            self.skipped[message.topic] = Skipped(1, f"at {when}: {why}")

    def _used(self) -> set[str]:
        names = self.read_topics
        used = {names.image, names.scan, names.camera_info, names.tf, names.tf_static, names.map}
        used |= {names.depth, names.depth_camera_info}
        used |= {names.truth} if self._with_truth else set()
        return {name for name in used if self._table.holds(name, *DECODABLE, *_PICTURES)}

    def _is_of_depth(self, topic: str) -> bool:
        names = self.read_topics
        return topic in (names.depth, names.depth_camera_info) and topic != names.image

    def _find_topics(self, asked: Topics) -> Topics:
        found = self._table.find(asked)
        asked_for = ("image", "scan", "camera_info", "tf", "tf_static", "map", "depth")
        for name in asked_for:
            before, after = getattr(asked, name), getattr(found, name)
            if before != after:
                self.notes.append(
                    f"{self.path}: nothing on {one_line(before)}; "
                    f"{one_line(after)} is read instead."
                )
        return found

    def _note_stamps(self) -> None:
        """Say when the messages' stamps and the time of recording are worlds apart."""
        offsets_s: list[float] = []
        if not self.is_bag:
            return
        try:
            for message in self._source.messages(
                self._used() & {self.read_topics.image, self.read_topics.scan}
            ):
                with suppress(TrackerError):  # counted by `events`
                    for event in message.read(Reading(self._max_pixels)):
                        if isinstance(event, CameraImage | Scan):
                            offsets_s.append((event.stamp_ns - message.log_ns) / 1e9)
                if len(offsets_s) >= _STAMPS_COMPARED:
                    break
        except RecordingError:  # told by `events`
            pass
        if offsets_s and abs(median(offsets_s)) > _WORTH_A_WORD_S:
            taken, other = ("header", "log") if self._stamps == "header" else ("log", "header")
            self.notes.append(
                f"{self.path}: the header stamps are {median(offsets_s):+.3f} s from the time of "
                f"recording; {taken} stamps are used, and could be {other} stamps."
            )


def _is_in_time(event: Event) -> bool:
    return isinstance(event, CameraModel | DepthCamera) or event.stamp_ns < _TOO_LATE_NS


def _restamped(event: Event, stamp_ns: int) -> Event:
    if isinstance(event, CameraModel | DepthCamera):
        return event
    return replace(event, stamp_ns=stamp_ns)
