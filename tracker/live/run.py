"""Events in, frames out, as on the robot; what was used can be recorded."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import ExitStack
from pathlib import Path

from tracker.camera import CameraModel
from tracker.containers import CameraImage, FrameResult, Scan
from tracker.errors import ClockError, TransformError
from tracker.messages import CameraInfo, Event
from tracker.pipeline import Pipeline
from tracker.recording import RecordingWriter
from tracker.transforms import StampedTransform

#: Of recorded pictures: hands are found as well as in raw ones.
_JPEG_QUALITY = 92

#: Told each processed image, what it led to, and the seconds that took.
Watcher = Callable[[CameraImage, FrameResult, float], None]


def run_live(
    events: Iterable[tuple[int, Event]],
    pipeline: Pipeline,
    *,
    watchers: Sequence[Watcher],
    record: Path | None = None,
) -> None:
    """Process what comes until it ends.

    Args:
        events: Pairs of log time and event, at their time.
        pipeline: Does the work; between two frames watchers may give it orders.
        watchers: Told of each processed image.
        record: An MCAP that `replay` reads: scans, transforms, intrinsics, and the images that
            were processed.

    Raises:
        RecordingError: The recording cannot be written.
    """
    with ExitStack() as held:
        writer = None
        if record is not None:
            writer = held.enter_context(RecordingWriter(record, jpeg_quality=_JPEG_QUALITY))
        for log_ns, event in events:
            try:
                verdict = pipeline.add(event, log_ns)
            except (TransformError, ClockError):
                continue
            is_used = verdict is None or verdict.is_admitted
            if writer is not None and is_used:
                _record(writer, log_ns, event)
            began_s = time.perf_counter()
            for image, result in pipeline.advance(log_ns):
                busy_s = time.perf_counter() - began_s
                for watch in watchers:
                    watch(image, result, busy_s)
                began_s = time.perf_counter()


def _record(writer: RecordingWriter, log_ns: int, event: Event) -> None:
    if isinstance(event, CameraModel):
        if event.width and event.height:
            info = CameraInfo(log_ns, "camera_link", event.width, event.height, event)
            writer.write("/camera_info", log_ns, info)
    elif isinstance(event, CameraImage):
        writer.write("/image_raw", log_ns, event)
    elif isinstance(event, Scan):
        writer.write("/scan", log_ns, event)
    elif isinstance(event, StampedTransform):
        writer.write("/tf_static" if event.is_static else "/tf", log_ns, event)
