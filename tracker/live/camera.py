"""The newest picture of a camera: a thread reads, and pictures not taken in time are dropped."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator

import cv2
import numpy as np

from tracker.closing import Closing
from tracker.containers import CameraImage
from tracker.errors import RecordingError

#: From one attempt to open a camera that has gone to the next (guess).
_RETRY_S = 2.0


class CameraStream(Closing):
    """A webcam, a device or a network camera; a context manager.

    Args:
        source: A camera's number, a device's path, an address (rtsp://, http://), or a GStreamer
            pipeline, which has a `!` in it and ends in `appsink`.
        tell: Told in words what happens: opened, lost, back again.
        must_be_there: Refuse a camera that cannot be opened at once; else it is waited for.

    Raises:
        RecordingError: The camera cannot be opened, and must be there.
    """

    def __init__(
        self, source: str, tell: Callable[[str], None], *, must_be_there: bool = True
    ) -> None:
        self._source, self._tell = source, tell
        self._stop = threading.Event()
        self._news = threading.Condition()
        self._newest: CameraImage | None = None
        capture = self._open()
        if capture is None and must_be_there:
            raise RecordingError(
                f"There is no camera {source} that can be opened. Without one: "
                "raised-hand live --simulated"
            )
        self._thread = threading.Thread(
            target=self._read, args=(capture,), name="camera", daemon=True
        )
        self._thread.start()

    def images(self) -> Iterator[CameraImage]:
        """The newest picture, whenever there is a new one; ends with `close`."""
        while not self._stop.is_set():
            with self._news:
                self._news.wait_for(lambda: self._newest is not None or self._stop.is_set(), 0.5)
                image, self._newest = self._newest, None
            if image is not None:
                yield image

    def close(self) -> None:
        """Let the camera go."""
        self._stop.set()
        with self._news:
            self._news.notify_all()
        self._thread.join(_RETRY_S + 1.0)

    def _open(self) -> cv2.VideoCapture | None:
        if self._source.isdecimal():
            capture = cv2.VideoCapture(int(self._source))
        elif "!" in self._source:
            capture = cv2.VideoCapture(self._source, cv2.CAP_GSTREAMER)
        else:
            capture = cv2.VideoCapture(self._source)
        if not capture.isOpened():
            capture.release()
            return None
        capture.set(cv2.CAP_PROP_BUFFERSIZE, 1)
        return capture

    def _read(self, capture: cv2.VideoCapture | None) -> None:
        if capture is None:
            self._tell(f"camera {self._source}: cannot be opened yet; trying again")
        while not self._stop.is_set():
            if capture is None:
                self._stop.wait(_RETRY_S)
                capture = self._open()
                if capture is not None:
                    self._tell(f"camera {self._source}: is open")
                continue
            is_read, bgr = capture.read()
            if not is_read:
                self._tell(f"camera {self._source}: sends no more pictures; trying again")
                capture.release()
                capture = None
                continue
            with self._news:
                self._newest = CameraImage(time.time_ns(), "", np.asarray(bgr, dtype=np.uint8))
                self._news.notify_all()
        if capture is not None:
            capture.release()
