"""What does the pipeline make of each image of a recording? For studies."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from tracker.camera import CameraModel
from tracker.containers import CameraImage, FrameResult, Scan
from tracker.errors import RecordingError, TransformError
from tracker.messages import Event
from tracker.pipeline import Pipeline
from tracker.recording import Topics, open_recording
from tracker.transforms import StampedTransform


def recorded_frames(
    source: str | Path,
    pipeline: Pipeline,
    *,
    topics: Topics | None = None,
    stamps: str = "header",
    progress: Callable[[float, int], None] = lambda share, images: None,
) -> Iterator[FrameResult]:
    """Run a recording through a pipeline.

    A recording that breaks off counts as far as it goes.

    Args:
        source: Whatever `replay` reads.
        pipeline: Fresh.
        topics: Where in the recording the data are.
        stamps: "header" or "log": which of a message's times counts.
        progress: Told the share that is done, and how many images were processed.

    Yields:
        Each processed image's result, while the pipeline stands at that image.

    Raises:
        RecordingError: The source cannot be opened, or holds no image that could be processed.
        ModelFileError: The hand models are not there.
    """
    images = 0
    with open_recording(source, topics or Topics(), stamps=stamps) as recording:
        recording.require_images()
        try:
            for log_ns, event in recording.events():
                now_ns = _feed(pipeline, event)
                if now_ns is not None:
                    for _, result in pipeline.advance(now_ns):
                        images += 1
                        yield result
                progress(recording.share(log_ns), images)
        except RecordingError:
            if not images:
                raise
        for _, result in pipeline.advance():
            images += 1
            yield result
    progress(1.0, images)
    if not images:
        raise RecordingError(f"{source}: holds no image that could be processed.")


def _feed(pipeline: Pipeline, event: Event) -> int | None:
    """Push one event into the pipeline; its stamp is the data's time now, if it has one."""
    if isinstance(event, CameraModel):
        pipeline.set_camera(event)
        return None
    if isinstance(event, StampedTransform):
        try:
            pipeline.add_transform(event)
        except TransformError:
            return None  # an unusable transform is none; `replay` is where problems are told
        return None if event.is_static else event.stamp_ns
    if isinstance(event, Scan):
        pipeline.add_scan(event)
    elif isinstance(event, CameraImage):
        pipeline.add_image(event)
    return event.stamp_ns
