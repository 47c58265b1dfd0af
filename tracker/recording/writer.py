"""How does a recording get onto the disk? As MCAP that `ros2 bag play`, RViz and Foxglove open."""

from __future__ import annotations

from copy import deepcopy
from glob import escape
from pathlib import Path
from typing import Any, BinaryIO

import yaml
from mcap.writer import CompressionType, Writer

from tracker.containers import CameraImage, DepthImage
from tracker.errors import RecordingError
from tracker.messages import Encodable, Encoded, definition, encode, type_hash
from tracker.outputs import GrowingFile, GrowingOutput, unwritable, writing_into
from tracker.recording.qos import offered_qos

#: The version of rosbag2's metadata whose QoS profiles Humble and Jazzy both read.
_METADATA_VERSION = 8


class RecordingWriter(GrowingOutput):
    """Writes containers as ROS 2 messages, streaming; a context manager.

    Whatever ends the `with` block, what was written until then can be read. An earlier recording
    is replaced when the new one is whole; until then the new one is `name.part.mcap` beside it.

    Args:
        path: A file that ends in `.mcap`, or else the folder of a rosbag2 recording.
        fixed_frame: The frame of `Tracks` and `Truth`.
        jpeg_quality: From 1 to 100: images go as CompressedImage onto `<topic>/compressed`, as
            image_transport has it, and depth images as PNG onto `<topic>/compressedDepth`.
        overwrite: Replace what is there.

    Raises:
        RecordingError: The path exists and `overwrite` is off, or it cannot be written.
    """

    def __init__(
        self,
        path: str | Path,
        *,
        fixed_frame: str = "map",
        jpeg_quality: int | None = None,
        overwrite: bool = False,
    ) -> None:
        self.path = Path(path)
        self._fixed_frame = fixed_frame
        self._jpeg_quality = jpeg_quality
        self._file, *metadata = recording_files(self.path)
        self._is_folder = bool(metadata)
        self._place = GrowingFile(self._file)
        self._stream = self._create(overwrite)
        self._mcap = Writer(self._stream, compression=CompressionType.LZ4)
        self._mcap.start(profile="ros2", library="raised-hand-tracker")
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, tuple[int, str]] = {}
        self._counts: dict[str, int] = {}
        self._first_ns: int | None = None
        self._last_ns = 0
        self._is_open = True

    def write(self, topic: str, log_ns: int, item: Encodable) -> None:
        """Write one item.

        Args:
            topic: Its topic; each topic carries one type.
            log_ns: The time at which it counts as recorded.
            item: Anything that `tracker.messages.encode` takes.

        Raises:
            RecordingError: The item has no message, the topic carries another type, the time is
                negative, the recording is closed or the disk full.
        """
        if not self._is_open:
            raise RecordingError(f"{self.path}: is closed; write inside the with block.")
        if not 0 <= log_ns < 2**63:
            raise RecordingError(f"{self.path}: a log time of {log_ns} ns came; it begins at 0.")
        if self._jpeg_quality is not None and isinstance(item, CameraImage):
            topic = f"{topic.removesuffix('/compressed')}/compressed"
        if self._jpeg_quality is not None and isinstance(item, DepthImage):
            topic = f"{topic}/compressedDepth"
        message = encode(item, frame_id=self._fixed_frame, jpeg_quality=self._jpeg_quality)
        log_ns = int(log_ns)
        try:
            channel = self._channel(topic, message)
            count = self._counts[topic]
            self._mcap.add_message(channel, log_ns, message.cdr, log_ns, sequence=count)
        except OSError as error:
            raise unwritable(self.path, error) from error
        self._counts[topic] = count + 1
        self._first_ns = log_ns if self._first_ns is None else min(self._first_ns, log_ns)
        self._last_ns = max(self._last_ns, log_ns)

    def close(self) -> None:
        """Write the index, and a folder's metadata.yaml; a second call does nothing.

        Raises:
            RecordingError: The disk is full.
        """
        if not self._is_open:
            return
        self._write_index()
        self._place.finish()
        if self._is_folder:
            self._write_metadata()

    def break_off(self) -> None:
        """As `GrowingOutput.break_off`."""
        if self._is_open:
            self._write_index()

    def _write_index(self) -> None:
        self._is_open = False
        text = yaml.safe_dump(self._metadata(), sort_keys=False)
        try:
            with self._stream:
                # rosbag2 reads its QoS profiles by the version in here.
                self._mcap.add_metadata("rosbag2", {"serialized_metadata": text})
                self._mcap.finish()  # type: ignore[no-untyped-call]  # mcap leaves it untyped
        except OSError as error:
            raise unwritable(self.path, error) from error

    def _write_metadata(self) -> None:
        whole = {"rosbag2_bagfile_information": self._metadata()}
        with writing_into(self.path) as new:
            text = yaml.safe_dump(whole, sort_keys=False)
            new("metadata.yaml").write_text(text, encoding="utf-8")
            for file in self.path.glob(f"{escape(self.path.name)}_*.mcap"):
                if file != self._file:  # a part of the recording that was replaced
                    file.unlink()

    def _create(self, overwrite: bool) -> BinaryIO:
        if self.path.exists() and not overwrite:
            raise RecordingError(
                f"{self.path}: exists already; choose another name, or replace it with --force."
            )
        if self.path.exists() and self.path.is_dir() != self._is_folder:
            kind = "a folder" if self._is_folder else "a file that ends in .mcap"
            raise RecordingError(f"{self.path}: is in the way; {kind} is to be written there.")
        try:
            self._file.parent.mkdir(parents=True, exist_ok=True)
            return self._place.path.open("wb")
        except OSError as error:
            raise unwritable(self.path, error) from error

    def _channel(self, topic: str, message: Encoded) -> int:
        if topic in self._channels:
            channel, type_name = self._channels[topic]
            if type_name != message.type_name:
                raise RecordingError(
                    f"{self.path}: {topic} carries {type_name}, and {message.type_name} came; "
                    "a topic carries one type."
                )
            return channel
        if message.type_name not in self._schemas:
            self._schemas[message.type_name] = self._mcap.register_schema(
                message.type_name, "ros2msg", definition(message.type_name).encode()
            )
        channel = self._mcap.register_channel(
            topic,
            "cdr",
            self._schemas[message.type_name],
            {
                "offered_qos_profiles": offered_qos(topic),
                "topic_type_hash": type_hash(message.type_name),
            },
        )
        self._channels[topic] = (channel, message.type_name)
        self._counts[topic] = 0
        return channel

    def _metadata(self) -> dict[str, Any]:
        first_ns, count = self._first_ns or 0, sum(self._counts.values())
        extent = {
            "duration": {"nanoseconds": self._last_ns - first_ns},
            "starting_time": {"nanoseconds_since_epoch": first_ns},
            "message_count": count,
        }
        topics = [
            {
                "topic_metadata": {
                    "name": topic,
                    "type": type_name,
                    "serialization_format": "cdr",
                    "offered_qos_profiles": offered_qos(topic),
                    "type_description_hash": type_hash(type_name),
                },
                "message_count": self._counts[topic],
            }
            for topic, (_, type_name) in self._channels.items()
        ]
        return {
            "version": _METADATA_VERSION,
            "storage_identifier": "mcap",
            **extent,
            "topics_with_message_count": topics,
            "compression_format": "",
            "compression_mode": "",
            "relative_file_paths": [self._file.name],
            "files": [{"path": self._file.name, **deepcopy(extent)}],  # no YAML references
            "custom_data": {},
            "ros_distro": "",
        }


def recording_files(path: Path) -> list[Path]:
    """The files of a new recording: a .mcap file, or those of a rosbag2 folder, data first."""
    if path.suffix.lower() == ".mcap":
        return [path]
    return [path / f"{path.name}_0.mcap", path / "metadata.yaml"]
