"""What does the pipeline make of each image of a recording? For studies."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

from tracker.containers import FrameResult
from tracker.errors import ClockError, RecordingError, TransformError
from tracker.pipeline import Pipeline
from tracker.recording import Topics, open_recording


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
    max_pixels = pipeline.config.picture_max_pixels
    with open_recording(
        source, topics or Topics(), stamps=stamps, max_pixels=max_pixels
    ) as recording:
        recording.require_images()
        try:
            for log_ns, event in recording.events():
                with suppress(TransformError, ClockError):  # `replay` is where problems are told
                    pipeline.add(event, log_ns)
                for _, result in pipeline.advance(log_ns):
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
