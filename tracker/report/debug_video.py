"""How does debug.mp4 come to be? Frame by frame, in the best encoding that OpenCV has here."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType

import cv2
import numpy as np

from tracker.containers import ImageArray
from tracker.errors import RecordingError

#: H.264 plays in browsers, but PyPI's OpenCV comes without an encoder for it (4.11 to 5.0); a
#: distribution's OpenCV mostly has one. VP9 would play too, at 0.1 to 1 s per frame of 640x480
#: (measured); MPEG-4 Part 2 takes 3 to 6 ms and plays in desktop players.
_ENCODINGS = ("avc1", "mp4v")

#: An mp4 is lost without its index, which is written last: stop while there is room for it.
_ROOM_BYTES = 16_000_000


class DebugVideo:
    """Writes pictures into an .mp4 file; a picture of another size is fitted into the first one's.

    Leaving the context, also by an exception, leaves a file that plays.

    Args:
        path: The file, replaced if it exists; it does not stay when no picture comes.
        rate_hz: Pictures per second at which it plays.

    Raises:
        RecordingError: The file cannot be created; later, that it cannot be written.
    """

    def __init__(self, path: str | Path, rate_hz: float) -> None:
        self._path = Path(path)
        self._rate_hz = rate_hz
        self._writer: cv2.VideoWriter | None = None
        self._size = (0, 0)
        self._frames = 0
        try:
            self._path.open("wb").close()
        except OSError as error:
            raise RecordingError(
                f"{self._path}: cannot be created ({error.strerror}); "
                "a folder that exists and may be written is needed."
            ) from error

    def write(self, bgr: ImageArray) -> None:
        """Append one picture.

        Args:
            bgr: Shape (height, width, 3), uint8, blue-green-red.

        Raises:
            RecordingError: No encoder takes it, or the disk is almost full.
        """
        if shutil.disk_usage(self._path.parent).free < _ROOM_BYTES:
            raise RecordingError(
                f"{self._path}: less than {_ROOM_BYTES / 1e6:.0f} MB are free after "
                f"{self._frames} pictures; make room on the disk, or write no video."
            )
        if self._writer is None:
            height, width = bgr.shape[:2]
            self._size = (width + width % 2, height + height % 2)  # encoders want even sides
            self._writer = self._open()
        self._writer.write(_fit(bgr, self._size))
        self._frames += 1

    def close(self) -> None:
        """Nothing more comes; write the index.

        Raises:
            RecordingError: The finished file does not hold every picture.
        """
        self._release()
        if self._frames == 0:
            return
        reader = cv2.VideoCapture(str(self._path), cv2.CAP_FFMPEG)
        held = int(reader.get(cv2.CAP_PROP_FRAME_COUNT)) if reader.isOpened() else 0
        reader.release()
        if held < self._frames:
            raise RecordingError(
                f"{self._path}: holds {held} of {self._frames} pictures; is the disk full?"
            )

    def __enter__(self) -> DebugVideo:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if kind is None:
            self.close()
        else:
            self._release()  # the first error is the one to tell

    def _open(self) -> cv2.VideoWriter:
        with _quiet_opencv():
            for name in _ENCODINGS:
                code = cv2.VideoWriter.fourcc(*name)
                writer = cv2.VideoWriter(
                    str(self._path), cv2.CAP_FFMPEG, code, self._rate_hz, self._size
                )
                if writer.isOpened():
                    return writer
        raise RecordingError(
            f"{self._path}: this OpenCV ({cv2.__version__}) encodes none of "
            f"{', '.join(_ENCODINGS)} at {self._size[0]}x{self._size[1]}; "
            "install opencv-python-headless, or write no video."
        )

    def _release(self) -> None:
        if self._writer is not None:
            self._writer.release()
            self._writer = None
        if self._frames == 0:
            self._path.unlink(missing_ok=True)


def side_by_side(left: ImageArray, right: ImageArray) -> ImageArray:
    """Two pictures next to each other, the right one fitted to the left one's height.

    Args:
        left: Shape (height, width, 3).
        right: Shape (any, any, 3).

    Returns:
        Shape (height, width + width', 3).
    """
    height = left.shape[0]
    if right.shape[0] != height:
        width = max(1, round(right.shape[1] * height / right.shape[0]))
        right = _resize(right, width, height)
    return np.hstack([left, right])


def _fit(bgr: ImageArray, size: tuple[int, int]) -> ImageArray:
    height, width = bgr.shape[:2]
    if (width, height) == size:
        return np.ascontiguousarray(bgr)
    if size[0] - width not in (0, 1) or size[1] - height not in (
        0,
        1,
    ):  # odd sides are only padded
        share = min(size[0] / width, size[1] / height)
        width, height = max(1, round(width * share)), max(1, round(height * share))
        bgr = _resize(bgr, width, height)
    canvas = np.zeros((size[1], size[0], 3), np.uint8)
    top, left = (size[1] - height) // 2, (size[0] - width) // 2
    canvas[top : top + height, left : left + width] = bgr
    return canvas


def _resize(bgr: ImageArray, width: int, height: int) -> ImageArray:
    return np.asarray(cv2.resize(bgr, (width, height), interpolation=cv2.INTER_AREA), np.uint8)


@contextmanager
def _quiet_opencv() -> Iterator[None]:
    """OpenCV complains on stderr about each encoder that it lacks; we only ask."""
    logging = getattr(cv2.utils, "logging", cv2)  # OpenCV 5 moved it
    level = logging.getLogLevel()
    logging.setLogLevel(0)
    name = "OPENCV_FFMPEG_LOGLEVEL"
    is_ours = name not in os.environ
    if is_ours:
        os.environ[name] = "-8"
    try:
        yield
    finally:
        logging.setLogLevel(level)
        if is_ours:
            del os.environ[name]
