"""`raised-hand play`: publish a recording as if its robot were here."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path

from rosbags.interfaces import Qos, QosDurability, QosReliability
from rosbags.rosbag2 import Reader, ReaderError

from nodes.dds.arrival import Arrival
from nodes.dds.endpoints import Publisher
from nodes.dds.node import Node
from nodes.dds.profiles import CLOCK, DEFAULT
from nodes.shared.qos import PROFILES, Profile
from nodes.shared.topics import Input
from tracker.camera import CameraModel, DepthCamera
from tracker.closing import Closing
from tracker.containers import CameraImage, DepthImage, OccupancyGrid, Scan
from tracker.errors import ConfigError, RecordingError
from tracker.messages import CameraInfo, Encodable, Event, encode, types
from tracker.messages.types import build, serialize, typestore
from tracker.recording import Recording, open_recording
from tracker.recording.bags import open_bag
from tracker.recording.sources import RawMessage, Source
from tracker.transforms import StampedTransform

#: Hidden from ROS 2's tools by its first letter, as their own helpers are: `ros2 param list` waits
#: 5 s for each node that is seen and serves no parameters.
NODE_NAME = "_raised_hand_play"

_CLOCK_TYPE = "rosgraph_msgs/msg/Clock"
#: As `ros2 bag play --clock`: 40 Hz.
_CLOCK_PERIOD_NS = 25_000_000

#: What is late is made up for at this pace: who listens loses what comes in one go. 30 raw
#: pictures of 1920x1080 are 187 MB; taking in each costs 6 ms on a common laptop.
_BYTES_PER_S = 400e6

_SENSOR_TYPES = (types.IMAGE, types.COMPRESSED_IMAGE, types.LASER_SCAN, types.CAMERA_INFO)

#: Told the share of the recording that is through, and the messages sent.
Progress = Callable[[float, int], None]


@dataclass(slots=True)
class Played:
    """What was sent.

    Attributes:
        counts: Messages by topic.
        lost: Messages that a slow reliable reader left no room for.
        worst_lag_s: How late the latest message was.
        skipped: Why some topics were left out, as sentences.
        doubts: What may not have arrived, and why, as sentences.
    """

    counts: dict[str, int] = field(default_factory=dict)
    lost: int = 0
    worst_lag_s: float = 0.0
    skipped: list[str] = field(default_factory=list)
    doubts: list[str] = field(default_factory=list)


def play(
    source: str | Path,
    *,
    rate: float = 1.0,
    loop: bool = False,
    start_offset_s: float = 0.0,
    clock: bool = False,
    best_effort: bool = False,
    topics: Collection[str] | None = None,
    remaps: Iterable[str] = (),
    delay_s: float = 1.0,
    progress: Progress | None = None,
) -> Played:
    """Publish a recording in real time, with the quality of service it was recorded with.

    Messages of ROS 2 recordings go out byte by byte as they were recorded, stamps included. What
    ROS 1 bags, videos and photos show is said again in ROS 2's messages.

    Args:
        source: Anything that `open_recording` opens.
        rate: How many times as fast as it was recorded.
        loop: Begin again at the end, until interrupted.
        start_offset_s: Begin so far into the recording; what is latched before is sent at once.
        clock: Also publish the time of recording on /clock, for nodes with use_sim_time.
        best_effort: Offer images, scans and CameraInfo best effort, as drivers do, however they
            were recorded.
        topics: Only these; by default all.
        remaps: Rules `from:=to`.
        delay_s: Before the first message, for subscribers to find the publishers.
        progress: Called for every message.

    Raises:
        ConfigError: An argument is off, or DDS cannot start.
        RecordingError: The recording cannot be read, or is damaged; what comes before the damage
            has been sent.
    """
    if not 0.01 <= rate <= 1000.0:
        raise ConfigError(f"The rate is {rate:g}; allowed is 0.01 to 1000.")
    if not 0.0 <= start_offset_s < 1e9 or not 0.0 <= delay_s < 1e6:
        raise ConfigError("Start offset and delay are seconds and must not be negative.")
    played = Played()
    tape = _Tape(Path(source), topics, best_effort=best_effort)
    with tape, Node(NODE_NAME, remaps=remaps) as node:
        played.skipped = tape.skipped
        publishers = {
            topic: node.publisher(topic, type_name, tape.profile(topic))
            for topic, type_name in tape.types.items()
        }
        ticks = node.publisher("/clock", _CLOCK_TYPE, CLOCK) if clock else None
        arrival = Arrival(node.domain_id, publishers)
        time.sleep(delay_s)
        first_ns = tape.start_ns + round(start_offset_s * 1e9)
        while True:
            for message in _paced(tape, first_ns, rate, ticks, played):
                publishers[message.topic].publish(message.data)
                played.counts[message.topic] = played.counts.get(message.topic, 0) + 1
                if progress is not None:
                    progress(tape.share(message.log_ns), sum(played.counts.values()))
            played.lost = sum(publisher.lost for publisher in publishers.values())
            if not loop:
                break
        time.sleep(min(delay_s, 0.2))  # the last messages are still on their way
        played.doubts = arrival.doubts(played.counts, played.worst_lag_s)
    return played


class _Tape(Closing):
    """The messages of a recording as ROS 2 would send them; a context manager."""

    def __init__(self, path: Path, topics: Collection[str] | None, *, best_effort: bool) -> None:
        self._path = path
        self._best_effort = best_effort
        self.skipped: list[str] = []
        with ExitStack() as opened:
            # The recording knows of kinds, damage and missing metadata; the source has the bytes.
            self._recording = opened.enter_context(open_recording(path))
            self._source: Source | None = None
            if self._recording.summary.kind == "ROS 2 recording":
                self._source = open_bag(path)
                opened.callback(self._source.close)
            self._offered = _offered(path) if self._source else {}
            self.types = self._choose(topics)
            self._opened = opened.pop_all()
        self.start_ns = self._recording.summary.start_ns

    def close(self) -> None:
        """Let go of the files."""
        self._opened.close()

    def share(self, log_ns: int) -> float:
        """How far into the recording a time is."""
        return self._recording.share(log_ns)

    def profile(self, topic: str) -> Profile:
        """As it was offered when it was recorded, or as is its custom."""
        latched = {"/tf_static": Input.STATIC_TRANSFORMS, "/map": Input.MAP}
        custom = PROFILES[latched[topic]] if topic in latched else DEFAULT
        offered = self._offered.get(topic, custom)
        is_sensor = self.types[topic] in _SENSOR_TYPES
        return offered._replace(reliable=False) if self._best_effort and is_sensor else offered

    def messages(self) -> Iterator[RawMessage]:
        """From the beginning, in log-time order."""
        if self._source is not None:
            for message in self._source.messages(self.types):
                yield message._replace(data=bytes(message.data))
            return
        size: tuple[int, int, str] | None = None
        for log_ns, event in self._recording.events():
            if isinstance(event, CameraImage):
                size = event.width, event.height, event.frame_id
            said = _said(event, self._recording, log_ns, size)
            if said is not None and said[0] in self.types:
                topic, encoded = said[0], encode(said[1])
                yield RawMessage(topic, encoded.type_name, log_ns, encoded.cdr)

    def _choose(self, topics: Collection[str] | None) -> dict[str, str]:
        found = (
            {topic: info.type_name for topic, info in self._source.topics.items()}
            if self._source is not None
            else _said_types(self._recording)
        )
        for topic in topics or ():
            if topic not in found:
                raise ConfigError(
                    f"{self._path}: has no topic {topic!r}; there are {', '.join(found)}."
                )
        chosen = {}
        for topic, type_name in found.items():
            if topics and topic not in topics:
                continue
            if type_name in typestore().fielddefs:
                chosen[topic] = type_name
            else:
                self.skipped.append(
                    f"{topic}: its type {type_name} is not supported; it is skipped."
                )
        if not chosen:
            names = ", ".join(found) or "none"
            raise RecordingError(
                f"{self._path}: contains nothing to play; its topics are {names}."
            )
        return chosen


def _paced(
    tape: _Tape, first_ns: int, rate: float, ticks: Publisher | None, played: Played
) -> Iterator[RawMessage]:
    """Each message when its time has come."""
    began_s: float | None = None
    next_tick_ns = first_ns
    for message in tape.messages():
        if message.log_ns < first_ns:
            if tape.profile(message.topic).transient_local:
                yield message
            continue
        if began_s is None:  # reading as far as here takes time in a large file
            began_s, first_ns = time.monotonic(), message.log_ns
        due_s = began_s + (message.log_ns - first_ns) / 1e9 / rate
        wait_s = due_s - time.monotonic()
        played.worst_lag_s = max(played.worst_lag_s, -wait_s)
        time.sleep(max(wait_s, len(message.data) / _BYTES_PER_S))
        if ticks is not None and message.log_ns >= next_tick_ns:
            ticks.publish(_clock_cdr(message.log_ns))
            next_tick_ns = message.log_ns + _CLOCK_PERIOD_NS
        yield message


def _clock_cdr(log_ns: int) -> bytes:
    sec, nanosec = divmod(log_ns, 1_000_000_000)
    now = build("builtin_interfaces/msg/Time", sec=sec, nanosec=nanosec)
    return serialize(build(_CLOCK_TYPE, clock=now)).cdr


def _offered(path: Path) -> dict[str, Profile]:
    """With which quality of service the topics were recorded, as far as the recording says."""
    found: dict[str, Profile] = {}
    try:
        with Reader(path) as reader:
            for connection in reader.connections:
                offered: list[Qos] = list(getattr(connection.ext, "offered_qos_profiles", ()))
                if offered:
                    first = offered[0]
                    found[connection.topic] = Profile(
                        first.reliability is not QosReliability.BEST_EFFORT,
                        first.durability is QosDurability.TRANSIENT_LOCAL,
                        first.depth if 0 < first.depth < 2**31 else DEFAULT.depth,
                        "As recorded.",
                    )
    except (ReaderError, OSError):  # damaged: what can be read of it is played all the same
        pass
    return found


def _said(
    event: Event, recording: Recording, log_ns: int, size: tuple[int, int, str] | None
) -> tuple[str, Encodable] | None:
    """Topic and container of what a ROS 1 bag or a video shows."""
    topics = recording.read_topics
    match event:
        case CameraImage():
            return topics.image, event
        case Scan():
            return topics.scan, event
        case DepthImage():
            return topics.depth.removesuffix("/compressedDepth"), event
        case DepthCamera():
            own = event.camera
            info = CameraInfo(log_ns, "", own.width or 0, own.height or 0, own)
            return topics.depth_camera_info, info
        case StampedTransform():
            return topics.tf_static if event.is_static else topics.tf, event
        case OccupancyGrid():
            return topics.map, event
        case CameraModel() if size is not None:  # it does not know its frame
            width, height, frame_id = size
            of = (event.width or width, event.height or height)
            return topics.camera_info, CameraInfo(log_ns, frame_id, *of, event)
    return None


def _said_types(recording: Recording) -> dict[str, str]:
    topics = recording.read_topics
    kinds = {
        topics.image: (recording.has_images, types.IMAGE),
        topics.scan: (recording.has_scans, types.LASER_SCAN),
        topics.camera_info: (recording.has_camera_info, types.CAMERA_INFO),
        topics.map: (recording.has_map, types.OCCUPANCY_GRID),
        topics.depth.removesuffix("/compressedDepth"): (recording.has_depth, types.IMAGE),
        topics.depth_camera_info: (recording.has_depth, types.CAMERA_INFO),
        topics.tf: (recording.has_transforms, types.TF_MESSAGE),
        topics.tf_static: (recording.has_transforms, types.TF_MESSAGE),
    }
    return {topic: type_name for topic, (is_there, type_name) in kinds.items() if is_there}
