"""Writes debug.mp4, picture by picture, as H.264, which every browser plays.

The file grows in fragments of about a second: a kill costs the last of them. When it is whole it
gets the index of an ordinary .mp4.
"""

from __future__ import annotations

from contextlib import suppress
from fractions import Fraction
from pathlib import Path

import av
import cv2
import numpy as np

from tracker.containers import ImageArray
from tracker.errors import OutputError
from tracker.outputs import GrowingFile, GrowingOutput, unwritable

_CONTAINER = {
    "movflags": "hybrid_fragmented+frag_keyframe+default_base_moof",
    "flush_packets": "1",
}
#: Without looking ahead, so that a picture that was written is in the file. A slower preset makes
#: the file a third smaller and takes twice the time, a seventh of the whole chain's.
_ENCODER = {"preset": "ultrafast", "tune": "zerolatency", "crf": "25"}


class DebugVideo(GrowingOutput):
    """Writes pictures into an .mp4 file; a picture of another size is fitted into the first one's.

    Leaving the context, also by an exception, leaves a file that plays.

    Args:
        path: The file; an earlier one is replaced at the end, and goes when no picture came.
        rate_hz: Pictures per second at which it plays.

    Raises:
        OutputError: What a kill left there cannot be removed.
    """

    def __init__(self, path: str | Path, rate_hz: float) -> None:
        self._path = Path(path)
        self._place = GrowingFile(self._path)
        self._rate_hz = Fraction(rate_hz).limit_denominator(1000)
        self._size = (0, 0)
        self._container: av.container.OutputContainer | None = None

    def write(self, bgr: ImageArray) -> None:
        """Append one picture.

        Args:
            bgr: Shape (height, width, 3), uint8, blue-green-red.

        Raises:
            OutputError: The file cannot be written, or no encoder takes the picture.
        """
        try:
            if self._container is None:
                height, width = bgr.shape[:2]
                self._size = (width + width % 2, height + height % 2)  # encoders want even sides
                self._open()
            picture = av.VideoFrame.from_ndarray(_fit(bgr, self._size), format="bgr24")
            self._encode(picture)
        except OSError as error:
            raise unwritable(self._path, error) from error
        except av.FFmpegError as error:
            raise OutputError(f"{self._path}: cannot be encoded ({error}).") from error

    def close(self) -> None:
        """The video is whole: write its index; it replaces an earlier one.

        Raises:
            OutputError: The disk is full.
        """
        try:
            if self._container is not None:
                self._encode(None)
                container, self._container = self._container, None
                container.close()
        except OSError as error:
            raise unwritable(self._path, error) from error
        self._place.finish()

    def break_off(self) -> None:
        """As `GrowingOutput.break_off`."""
        if self._container is not None:
            with suppress(OSError):  # the first error is the one to tell
                self._container.close()
            self._container = None

    def _open(self) -> None:
        self._container = av.open(str(self._place.path), "w", format="mp4", options=_CONTAINER)
        self._stream = self._container.add_stream("libx264", self._rate_hz, options=_ENCODER)
        self._stream.width, self._stream.height = self._size
        self._stream.pix_fmt = "yuv420p"
        self._stream.codec_context.gop_size = max(1, round(self._rate_hz))

    def _encode(self, picture: av.VideoFrame | None) -> None:
        assert self._container is not None
        self._container.mux(self._stream.encode(picture))


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
