"""How are whole recordings read? rosbag2 folders, .mcap, .db3 and ROS 1 .bag files, by rosbags."""

from __future__ import annotations

import struct
from collections.abc import Collection, Iterator
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any, cast

import apsw
from rosbags.rosbag1 import Reader as Ros1Reader
from rosbags.rosbag1 import ReaderError as Ros1Error
from rosbags.rosbag2 import Reader as Ros2Reader
from rosbags.rosbag2 import ReaderError as Ros2Error
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from tracker.errors import RecordingError
from tracker.messages import Event, decode, events_from_message
from tracker.messages.types import MALFORMED, TF_MESSAGE, TF_MESSAGE_ROS1
from tracker.recording.cut_mcap import CutMcapSource
from tracker.recording.sources import RawMessage, Row, Source, TopicInfo, seconds_into, unreadable

#: What rosbags raises for files that are damaged, when opened or later on.
_DAMAGED = (
    Ros1Error, Ros2Error, apsw.Error, OSError, EOFError, RuntimeError, struct.error,
    ValueError, TypeError, KeyError, IndexError, AssertionError,
)  # fmt: skip

_REMEDIES = {
    ".bag": "Is it a ROS 1 bag? If its recording was cut off, repair it with `rosbag reindex`.",
    ".db3": (
        "Is it a rosbag2 database? If it is damaged, repair it with "
        "`sqlite3 old.db3 .recover | sqlite3 new.db3`."
    ),
    ".mcap": "Is it an MCAP file of ROS 2 messages?",
    "": "Is it a rosbag2 folder? `ros2 bag reindex` renews its metadata.yaml.",
}


class BagSource:
    """Everything that rosbags can open.

    Args:
        path: A rosbag2 folder with its metadata, a .mcap, .db3 or .bag file.

    Raises:
        RecordingError: It cannot be opened.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._is_ros1 = path.suffix == ".bag"
        self.kind = "ROS 1 bag" if self._is_ros1 else "ROS 2 recording"
        self.notes: list[str] = []
        try:
            self._reader = Ros1Reader(path) if self._is_ros1 else Ros2Reader(path)
            self._reader.open()
        except _DAMAGED as error:
            remedy = _REMEDIES["" if path.is_dir() else path.suffix]
            raise unreadable(path, error, remedy) from error
        self.topics = {
            topic: TopicInfo(info.msgtype or "several types", info.msgcount)
            for topic, info in self._reader.topics.items()
        }
        is_empty = self._reader.message_count == 0
        self.start_ns = 0 if is_empty else self._reader.start_time
        self.end_ns = 0 if is_empty else self._reader.end_time - 1

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        """As `Source.messages`."""
        wanted = [item for item in self._reader.connections if item.topic in topics]
        if not wanted:
            return
        log_ns = self.start_ns
        stream = self._reader.messages(connections=cast(Any, wanted))
        while True:
            try:
                connection, log_ns, data = next(stream)
            except StopIteration:
                return
            except _DAMAGED as error:
                raise RecordingError(
                    f"{self._path}: is damaged {seconds_into(log_ns, self.start_ns)} after its "
                    f"beginning ({error}). What came before was read."
                ) from error
            yield RawMessage(connection.topic, connection.msgtype, log_ns, data)

    def read(self, message: RawMessage, *, is_static: bool, max_pixels: int) -> list[Event]:
        """As `Source.read`."""
        if not self._is_ros1:
            return decode(
                message.type_name, message.data, is_static=is_static, max_pixels=max_pixels
            )
        try:
            said = _ros1_typestore().deserialize_ros1(message.data, message.type_name)
        except MALFORMED as error:
            raise RecordingError(
                f"{len(message.data)} bytes came as ROS 1 {message.type_name}; they do not hold "
                f"one ({error})."
            ) from error
        return events_from_message(
            message.type_name, said, is_static=is_static, max_pixels=max_pixels
        )

    def close(self) -> None:
        """As `Source.close`."""
        self._reader.close()


def open_bag(path: Path) -> Source:
    """Open a recording, whole or not.

    A .mcap file that lost its end is read up to there; a folder without usable metadata.yaml (a
    recorder that was killed) is read file by file.

    Raises:
        RecordingError: Nothing of it can be read.
    """
    try:
        return BagSource(path)
    except RecordingError as error:
        if path.is_file() and path.suffix == ".mcap":
            return CutMcapSource(path, str(error.__cause__))
        files = bag_files(path) if path.is_dir() else []
        if not files:
            raise
        has_metadata = (path / "metadata.yaml").exists()
        state = "cannot be used" if has_metadata else "is missing"
        parts: list[Source] = []
        try:
            parts.extend(open_bag(file) for file in files)
        except RecordingError:
            for part in parts:
                with suppress(RecordingError):
                    part.close()
            raise
        return Row("ROS 2 recording", parts, [f"{path}: metadata.yaml {state}; read by file."])


def bag_files(folder: Path) -> list[Path]:
    """The parts of a rosbag2 recording, in the order in which the recorder numbered them."""
    found = [file for file in folder.iterdir() if file.suffix in (".mcap", ".db3")]
    return sorted(found, key=lambda file: (len(file.name), file.name))


@lru_cache(maxsize=1)
def _ros1_typestore() -> Typestore:
    store = get_typestore(Stores.ROS1_NOETIC)
    for name in (TF_MESSAGE, TF_MESSAGE_ROS1):
        definition = "geometry_msgs/TransformStamped[] transforms\n"
        store.register(get_types_from_msg(definition, name))
    return store
