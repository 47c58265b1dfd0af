"""How do videos and folders of photos become a recording? Stamped from 0 on."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from tracker.containers import CameraImage, ImageArray
from tracker.errors import RecordingError
from tracker.messages import Event
from tracker.messages.images import Picture, picture_from_file
from tracker.messages.picture_size import MAX_PIXELS, PictureSize, check_pixels, picture_size
from tracker.recording.sources import RawMessage, Reading, TopicInfo, unreadable

VIDEO_SUFFIXES = frozenset({".mp4", ".avi", ".mkv", ".webm", ".mov", ".m4v"})
PHOTO_SUFFIXES = frozenset({".jpg", ".jpeg", ".png", ".bmp", ".webp"})

#: Containers estimate their number of frames from duration and rate; a shortfall below this share
#: (a guess) is no damage.
_MISSING_SHARE = 0.02

_FALLBACK_FPS = 30.0

#: The time of a frame, in periods, counted from before a video that begins late; OpenCV 4.8 does
#: not tell.
_FRAME_TIME: int | None = getattr(cv2, "CAP_PROP_PTS", None)

#: Larger files are not read into memory; 50 million pixels of 16 bits take 300 MB uncompressed.
_PHOTO_MAX_BYTES = 500_000_000


class VideoSource:
    """The frames of a video file on one topic.

    Args:
        path: A file that OpenCV can decode.
        topic: The topic they appear on.
        max_pixels: Larger frames are not decoded.

    Raises:
        RecordingError: Not one frame can be decoded, or frames are too large.
    """

    kind = "video"

    def __init__(self, path: Path, topic: str, max_pixels: int = MAX_PIXELS) -> None:
        self._path, self._topic = path, topic
        self.notes: list[str] = []
        capture = self._open()
        fps = capture.get(cv2.CAP_PROP_FPS)
        self._count = max(int(capture.get(cv2.CAP_PROP_FRAME_COUNT)), 0)
        size = PictureSize(
            int(capture.get(cv2.CAP_PROP_FRAME_WIDTH)), int(capture.get(cv2.CAP_PROP_FRAME_HEIGHT))
        )
        try:
            check_pixels(size, max_pixels, f"{path}: the video")
            readable, _ = capture.read()
        finally:
            capture.release()
        if not readable:
            raise unreadable(path, "not one frame can be decoded", _VIDEO_REMEDY)
        self._is_fps_known = bool(np.isfinite(fps) and 0.1 < fps < 1000.0)
        self._fps = fps if self._is_fps_known else _FALLBACK_FPS
        if not self._is_fps_known:
            self.notes.append(f"{path}: has no frame rate; {_FALLBACK_FPS:g} per second assumed.")
        self.topics = {topic: TopicInfo("video frames", self._count)}
        self.start_ns, self.end_ns = 0, int(max(self._count - 1, 0) / self._fps * 1e9)

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        """As `Source.messages`; stamps are the container's own, or frame number by frame rate."""
        if self._topic not in topics:
            return
        capture = self._open()
        period_ns = round(1e9 / self._fps)
        number, stamp_ns, late_frames = 0, 0, 0
        try:
            while True:
                readable, bgr = capture.read()
                if not readable:
                    break
                at_ns = round(capture.get(cv2.CAP_PROP_POS_MSEC) * 1e6)
                if not number and _FRAME_TIME is not None:
                    late_frames = round(capture.get(_FRAME_TIME))
                if number:  # some containers know no time, and some repeat one
                    stamp_ns = at_ns if at_ns > stamp_ns else stamp_ns + period_ns
                image = _image(stamp_ns, bgr)
                yield RawMessage(
                    self._topic, "", stamp_ns, [image], lambda message, _: message.data
                )
                number += 1
        finally:
            capture.release()
        # A rate that varies, or a piece cut out of a longer video, makes the container's count a
        # guess from its end; the time tells how far it went.
        reached = max(number, late_frames + round(stamp_ns / 1e9 * self._fps) + 1)
        if self._count - reached > max(_MISSING_SHARE * self._count, 3):
            raise RecordingError(
                f"{self._path}: cannot be decoded beyond frame {number} of {self._count} "
                f"({stamp_ns / 1e9:.3f} s). Everything before was read. {_VIDEO_REMEDY}"
            )

    def close(self) -> None:
        """Nothing stays open between calls."""

    def _open(self) -> cv2.VideoCapture:
        capture = cv2.VideoCapture(str(self._path))
        if not capture.isOpened():
            raise unreadable(self._path, "OpenCV cannot read a video from it", _VIDEO_REMEDY)
        capture.set(cv2.CAP_PROP_ORIENTATION_AUTO, 1)  # as phones are held; OpenCV 4.11 does not
        return capture


def _as_is(message: RawMessage, _: Reading) -> list[Event]:
    return list(message.data)


def _image(stamp_ns: int, bgr: Any) -> CameraImage:
    return CameraImage(stamp_ns, "", bgr)  # OpenCV decodes videos to BGR by default


_VIDEO_REMEDY = "Is the file cut off? `ffmpeg -i old.mkv new.mp4` often helps."


class PhotoSource:
    """A folder of photos on one topic, in natural order, each of a size of its own.

    Args:
        paths: The photos.
        topic: The topic they appear on.
        period_s: From one photo to the next.

    Raises:
        RecordingError: Not one of them can be decoded.
    """

    kind = "photos"

    def __init__(self, paths: list[Path], topic: str, period_s: float) -> None:
        self._paths = sorted(paths, key=lambda path: natural_order(path.name))
        self._topic, self._period_ns = topic, round(period_s * 1e9)
        self.notes: list[str] = []
        self.topics = {topic: TopicInfo("photos", len(paths))}
        self.start_ns, self.end_ns = 0, (len(paths) - 1) * self._period_ns
        if not any(_has_photo_header(path) for path in self._paths):
            raise unreadable(paths[0].parent, "not one photo can be decoded", "Look at the files.")

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        """As `Source.messages`."""
        if self._topic in topics:
            for number, path in enumerate(self._paths):
                yield RawMessage(self._topic, "", number * self._period_ns, path, _read)

    def close(self) -> None:
        """Nothing stays open between calls."""


def _read(message: RawMessage, how: Reading) -> list[Event]:
    picture = _read_picture(message.data, how.max_pixels)
    return [CameraImage(message.log_ns, "", picture.bgr, picture.remark)]


def read_photo(path: Path, max_pixels: int = MAX_PIXELS) -> ImageArray:
    """One photo, shape (height, width, 3), BGR.

    Raises:
        RecordingError: It cannot be read or decoded, or is too large.
    """
    return _read_picture(path, max_pixels).bgr


def _read_picture(path: Path, max_pixels: int) -> Picture:
    return picture_from_file(_bytes_of(path), f"{path}: the photo", max_pixels)


def _bytes_of(path: Path) -> NDArray[np.uint8]:
    try:
        size = path.stat().st_size
        if size > _PHOTO_MAX_BYTES:
            raise RecordingError(f"{path}: has {size} bytes; that is too large for a photo.")
        return np.frombuffer(path.read_bytes(), dtype=np.uint8)
    except OSError as error:
        raise unreadable(path, error.strerror, "Check its rights.") from error


def _has_photo_header(path: Path) -> bool:
    try:
        return picture_size(_bytes_of(path)) is not None
    except RecordingError:
        return False


def photos_in(folder: Path) -> list[Path]:
    """The photos of a folder, without those of its subfolders."""
    return [file for file in folder.iterdir() if file.suffix.lower() in PHOTO_SUFFIXES]


def natural_order(name: str) -> list[tuple[int, int, str]]:
    """A key that sorts `photo_2` before `photo_10`."""
    pieces = re.findall(r"\d+|\D+", name.lower())
    return [(0, int(piece), piece) if piece.isdecimal() else (1, 0, piece) for piece in pieces]
