"""Small recordings of every kind, and where in each file its messages lie."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import cv2
import zstandard
from mcap.reader import make_reader
from mcap.writer import CompressionType, IndexType, Writer
from rosbags.rosbag1 import Reader as Ros1Reader
from rosbags.rosbag1 import Writer as Ros1Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from tracker.messages import definition
from tracker.messages.types import deserialize
from tracker.simulation import load_scene, write_simulation

SCENE = """
title: A short visit
duration_s: 2.0
map_from_odom: {x_m: 0.0, y_m: 0.0, yaw_deg: 0.0}
walls:
  - corners_m: [[-1.5, -2.5], [3.5, -2.5], [3.5, 2.5], [-1.5, 2.5]]
    closed: true
people:
  - {id: 1, name: Ada, hand: left, seat_m: 0.5, path: [{x_m: 1.4, y_m: 0.4}],
     raises: [{from_s: 0.5, until_s: 1.5}], look: {hair_style: long, shirt: "#c2453e"}}
"""


class Message(NamedTuple):
    """One message as it was recorded."""

    topic: str
    log_ns: int
    type_name: str
    data: bytes


class Spans(NamedTuple):
    """Where the messages of a file are, one entry for each.

    Attributes:
        keys: Topic and log time.
        begins: Byte at which the chunk (or record) around it begins; its neighbor's end.
        ends: Byte after it, with what the format keeps behind it.
    """

    keys: list[tuple[str, int]]
    begins: list[int]
    ends: list[int]


class Kind(NamedTuple):
    """One kind of recording.

    Attributes:
        name: For the table.
        file: Its name, with the suffix; a folder's without.
        write: Writes it.
        spans: Finds the messages in it; None where damage cannot be told to a message.
        is_told: The format shows its damage; a video's decoder mends what it can in silence.
    """

    name: str
    file: str
    write: Callable[[Path, list[Message]], None]
    spans: Callable[[Path], Spans] | None
    is_told: bool = True


def simulated(folder: Path, seconds: float = 2.0) -> list[Message]:
    """What a simulated robot records, with pictures as JPEG."""
    scene, path = folder / "scene.yaml", folder / "base.mcap"
    scene.write_text(SCENE.replace("duration_s: 2.0", f"duration_s: {seconds}"))
    write_simulation(load_scene(scene), path, 1, jpeg_quality=60, overwrite=True)
    with path.open("rb") as file:
        return [
            Message(channel.topic, message.log_time, schema.name, message.data)
            for schema, channel, message in make_reader(file).iter_messages()
        ]


def kinds() -> list[Kind]:
    """Every kind that the campaign harms."""
    return [
        Kind("MCAP, lz4", "a.mcap", write_mcap(), mcap_spans),
        Kind("MCAP, zstd", "a.mcap", write_mcap(compression=CompressionType.ZSTD), mcap_spans),
        Kind(
            "MCAP, not compressed",
            "a.mcap",
            write_mcap(compression=CompressionType.NONE),
            mcap_spans,
        ),
        Kind("MCAP, no index", "a.mcap", write_mcap(index_types=IndexType.NONE), mcap_spans),
        Kind("MCAP, no chunks", "a.mcap", write_mcap(use_chunking=False), loose_spans),
        Kind("rosbag2 folder", "bag", _folder, None),
        Kind("rosbag2, .db3", "a.db3", write_database, None),
        Kind("compressed, .mcap.zstd", "a.mcap.zstd", _packed, None),
        Kind("ROS 1 bag, not compressed", "a.bag", _ros1(None), ros1_spans),
        Kind("ROS 1 bag, lz4", "a.bag", _ros1("LZ4"), ros1_spans),
        Kind("ROS 1 bag, bz2", "a.bag", _ros1("BZ2"), ros1_spans),
        Kind("video, .mp4", "a.mp4", _video("mp4v"), None, False),
        Kind("video, .avi", "a.avi", _video("MJPG"), None, False),
        Kind("photos", "photos", _photos, None),
    ]


def write_mcap(**settings: object) -> Callable[[Path, list[Message]], None]:
    def write(path: Path, messages: list[Message]) -> None:
        with path.open("wb") as file:
            writer, channels = Writer(file, **{"chunk_size": 60_000, **settings}), {}
            writer.start(profile="ros2", library="faults")
            for topic, log_ns, type_name, data in messages:
                if topic not in channels:
                    text = definition(type_name).encode()
                    schema = writer.register_schema(type_name, "ros2msg", text)
                    channels[topic] = writer.register_channel(topic, "cdr", schema)
                writer.add_message(channels[topic], log_ns, data, log_ns)
            writer.finish()

    return write


def _folder(path: Path, messages: list[Message]) -> None:
    path.mkdir()
    middle = len(messages) // 2
    for number, part in enumerate((messages[:middle], messages[middle:])):
        write_mcap()(path / f"bag_{number}.mcap", part)


def _packed(path: Path, messages: list[Message]) -> None:
    plain = path.with_name("plain.mcap")
    write_mcap()(plain, messages)
    path.write_bytes(zstandard.compress(plain.read_bytes()))
    plain.unlink()


def write_database(path: Path, messages: list[Message]) -> None:
    """A rosbag2 database, without its metadata."""
    database = sqlite3.connect(path)
    database.execute("CREATE TABLE topics (id INTEGER PRIMARY KEY, name TEXT, type TEXT)")
    database.execute(
        "CREATE TABLE messages (id INTEGER PRIMARY KEY, topic_id INT, timestamp INT, data BLOB)"
    )
    database.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
    topics: dict[str, int] = {}
    for topic, log_ns, type_name, data in messages:
        if topic not in topics:
            topics[topic] = len(topics) + 1
            row = (topics[topic], topic, type_name)
            database.execute("INSERT INTO topics VALUES (?, ?, ?)", row)
        row = (topics[topic], log_ns, data)
        database.execute("INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)", row)
    database.commit()
    database.close()


def _ros1(packing: str | None) -> Callable[[Path, list[Message]], None]:
    def write(path: Path, messages: list[Message]) -> None:
        store = get_typestore(Stores.ROS1_NOETIC)
        text = "geometry_msgs/TransformStamped[] transforms\n"
        store.register(get_types_from_msg(text, "tf2_msgs/msg/TFMessage"))
        writer = Ros1Writer(path)
        if packing is not None:
            writer.set_compression(Ros1Writer.CompressionFormat[packing])
        writer.chunk_threshold = 30_000
        with writer:
            connections = {}
            for topic, log_ns, type_name, data in messages:
                if "Detection" in type_name or "CameraInfo" in type_name:
                    continue  # of other fields there, or not known
                message = _as_ros1(store, deserialize(type_name, data))
                if topic not in connections:
                    connections[topic] = writer.add_connection(topic, type_name, typestore=store)
                raw = store.serialize_ros1(message, type_name)
                writer.write(connections[topic], log_ns, raw)

    return write


def _as_ros1(store, message):
    """The same message field by field; only its header has one more, `seq`."""
    if isinstance(message, list):
        return [_as_ros1(store, part) for part in message]
    name = getattr(message, "__msgtype__", None)
    if name is None:
        return message
    fields = [field for field, _ in store.fielddefs[name][1]]
    return store.types[name](
        **{field: _as_ros1(store, getattr(message, field, 0)) for field in fields}
    )


def _pictures(messages: list[Message]):
    for topic, _, type_name, data in messages:
        if topic.startswith("/image_raw"):
            jpeg = deserialize(type_name, data).data
            yield cv2.imdecode(jpeg, cv2.IMREAD_COLOR)


def _video(codec: str) -> Callable[[Path, list[Message]], None]:
    def write(path: Path, messages: list[Message]) -> None:
        pictures = list(_pictures(messages))
        height, width = pictures[0].shape[:2]
        size = (width // 2, height // 2)
        writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*codec), 30.0, size)
        for picture in pictures:
            writer.write(cv2.resize(picture, size))
        writer.release()

    return write


def _photos(path: Path, messages: list[Message]) -> None:
    path.mkdir()
    suffixes = ("jpg", "png", "webp", "bmp")
    for number, picture in enumerate(list(_pictures(messages))[:12]):
        small = cv2.resize(picture, None, fx=0.3, fy=0.3)
        cv2.imwrite(str(path / f"p{number:02d}.{suffixes[number % 4]}"), small)


def mcap_spans(path: Path) -> Spans:
    """By the chunks that the mcap library's stream reader sees."""
    from mcap.records import Channel, Chunk
    from mcap.records import Message as Record
    from mcap.stream_reader import StreamReader, breakup_chunk

    spans, topics, content = Spans([], [], []), {}, path.read_bytes()
    at = 0
    with path.open("rb") as file:
        for record in StreamReader(file, emit_chunks=True).records:
            if not isinstance(record, Chunk):
                continue
            begin = content.index(record.data, at)
            at = begin + len(record.data)
            for part in breakup_chunk(record):
                if isinstance(part, Channel):
                    topics[part.id] = part.topic
                elif isinstance(part, Record):
                    spans.keys.append((topics[part.channel_id], part.log_time))
                    spans.begins.append(begin - 60)
                    spans.ends.append(at)
    return spans


def loose_spans(path: Path) -> Spans:
    """By the records that the mcap library's stream reader sees."""
    from mcap.records import Channel
    from mcap.records import Message as Record
    from mcap.stream_reader import StreamReader

    spans, topics, content = Spans([], [], []), {}, path.read_bytes()
    at = 0
    with path.open("rb") as file:
        for record in StreamReader(file).records:
            if isinstance(record, Channel):
                topics[record.id] = record.topic
            elif isinstance(record, Record):
                begin = content.index(record.data, at)
                at = begin + len(record.data)
                spans.keys.append((topics[record.channel_id], record.log_time))
                spans.begins.append(begin - 31)
                spans.ends.append(at)
    return spans


def ros1_spans(path: Path) -> Spans:
    """By the index of chunks that rosbags reads."""
    spans = Spans([], [], [])
    with Ros1Reader(path) as reader:
        places = sorted(reader.chunks)
        following = {a: b for a, b in zip(places, [*places[1:], path.stat().st_size], strict=True)}
        for connection, log_ns, _ in reader.messages():
            index = reader.indexes[connection.id]
            entry = next(item for item in index if item.time == log_ns)
            spans.keys.append((connection.topic, log_ns))
            spans.begins.append(entry.chunk_pos)
            spans.ends.append(following[entry.chunk_pos])
    return spans
