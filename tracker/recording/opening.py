"""Which kind of recording is this? By its suffix, and by what a folder holds."""

from __future__ import annotations

from pathlib import Path

from tracker.errors import RecordingError
from tracker.messages.picture_size import MAX_PIXELS
from tracker.recording.bags import bag_files, is_bag_file, open_bag
from tracker.recording.pictures import (
    PHOTO_SUFFIXES,
    VIDEO_SUFFIXES,
    PhotoSource,
    VideoSource,
    photos_in,
)
from tracker.recording.recording import Recording
from tracker.recording.sources import Source
from tracker.recording.topics import Topics

_BAG_SUFFIXES = frozenset({".mcap", ".db3", ".bag", ".mcap.zstd", ".db3.zstd"})


def open_recording(
    path: str | Path,
    topics: Topics | None = None,
    *,
    with_truth: bool = False,
    stamps: str = "header",
    photo_period_s: float = 0.1,
    max_pixels: int = MAX_PIXELS,
) -> Recording:
    """Open a recording for reading; use it in a `with` block.

    Args:
        path: A rosbag2 folder, a .mcap, .db3 (also packed, .zstd) or ROS 1 .bag file, a video,
            photos.
        topics: Where it holds what; by default the specification's names.
        with_truth: Also deliver simulated people.
        stamps: Which time the data carry: `header`, the messages' own, or `log`, that of the
            recording.
        photo_period_s: From one photo to the next.
        max_pixels: Larger pictures are passed over before they are decoded, and counted.

    Raises:
        RecordingError: There is no such file, or it is no recording, or cannot be read at all; or
            `stamps` is neither.
    """
    path, topics = Path(path), topics or Topics()
    source = _open_source(path, topics.image, photo_period_s, max_pixels)
    try:
        return Recording(
            path, source, topics, with_truth=with_truth, stamps=stamps, max_pixels=max_pixels
        )
    except RecordingError:
        source.close()
        raise


def _open_source(path: Path, image_topic: str, photo_period_s: float, max_pixels: int) -> Source:
    if not path.exists():
        raise RecordingError(f"{path}: there is no such file or folder; check the name.")
    suffix = path.suffix.lower()
    if path.is_dir():
        if (path / "metadata.yaml").exists() or bag_files(path):
            return open_bag(path)
        photos = photos_in(path)
        if not photos:
            raise RecordingError(
                f"{path}: contains neither a rosbag2 recording nor photos; expected a folder with "
                f"metadata.yaml, or with {', '.join(sorted(PHOTO_SUFFIXES))} files."
            )
        return PhotoSource(photos, image_topic, photo_period_s)
    if is_bag_file(path):
        return open_bag(path)
    if suffix in VIDEO_SUFFIXES:
        return VideoSource(path, image_topic, max_pixels)
    if suffix in PHOTO_SUFFIXES:
        return PhotoSource([path], image_topic, photo_period_s)
    known = sorted(_BAG_SUFFIXES | VIDEO_SUFFIXES | PHOTO_SUFFIXES)
    raise RecordingError(
        f"{path}: has no supported format; supported are {', '.join(known)} and folders."
    )
