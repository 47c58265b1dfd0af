"""What to watch: a camera, or a recording or scene that plays at the pace of the clock."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from tracker.errors import RecordingError
from tracker.geometry import RigidTransform
from tracker.live.camera import CameraStream
from tracker.messages import Event
from tracker.recording import Topics, open_recording
from tracker.simulation import load_scene, simulate
from tracker.transforms import StampedTransform

#: Where the computer is later than this, the clock of what is played waits for it.
_LATE_S = 0.2

Events = Iterator[tuple[int, Event]]


@contextmanager
def live_events(
    source: str, topics: Topics, tell: Callable[[str], None], fixed_frame: str
) -> Iterator[Events]:
    """Everything that a source gives, each at its time.

    Args:
        source: As of `CameraStream`, or a recording's or video's path.
        topics: Where in a recording the data are.
        tell: Told in words what happens.
        fixed_frame: A camera or video without transforms is supposed to stand at its origin.

    Yields:
        Pairs of log time and event, as `Recording.events`.

    Raises:
        RecordingError: There is no such camera or recording.
    """
    path = Path(source)
    is_file = path.is_dir() or path.is_file()
    if is_file:
        with open_recording(path, topics) as recording:
            origin = [] if recording.is_bag else [_origin(fixed_frame, 0)]
            yield paced(_chain(origin, recording.events()))
        return
    is_address = "://" in source or "!" in source
    if not (is_address or source.isdecimal() or source.startswith("/dev/")):
        raise RecordingError(
            f"{source}: is neither an existing file nor a camera; a camera is a number, a device "
            "such as /dev/video0, an address such as rtsp://..., or a GStreamer pipeline."
        )
    with CameraStream(source, tell, must_be_there=not is_address) as camera:
        origin = [_origin(fixed_frame, time.time_ns())]
        images = ((image.stamp_ns, image) for image in camera.images())
        yield _chain(origin, images)


def simulated_events(scene: str, seed: int, rate_hz: float) -> Events:
    """A scene, rendered while it plays, over and over with stamps that go on.

    Args:
        scene: A name of config/scenes or a YAML file.
        seed: Of the noise of the first round.
        rate_hz: Pictures a second: to render more than are processed would be in vain.
    """
    played = load_scene(scene)
    camera = played.camera.model_copy(update={"rate_hz": min(rate_hz, played.camera.rate_hz)})
    played = played.model_copy(update={"camera": camera})
    run = 0
    while True:
        start_s = int(played.start_s + run * (played.duration_s + 2.0))
        yield from simulate(played.model_copy(update={"start_s": start_s}), seed + run)
        run += 1


def paced(
    events: Events,
    *,
    now_s: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], None] = time.sleep,
) -> Events:
    """Hand each event over at its time; what is too much for the computer plays slower."""
    began: tuple[float, int] | None = None
    for log_ns, event in events:
        if began is None and not isinstance(event, StampedTransform):
            began = now_s(), log_ns
        if began is not None:
            ahead_s = (log_ns - began[1]) / 1e9 - (now_s() - began[0])
            if ahead_s > 0.0:
                sleep(ahead_s)
            elif ahead_s < -_LATE_S:
                began = now_s(), log_ns
        yield log_ns, event


def _chain(first: list[tuple[int, Event]], then: Events) -> Events:
    yield from first
    yield from then


def _origin(fixed_frame: str, stamp_ns: int) -> tuple[int, Event]:
    sample = StampedTransform(
        stamp_ns, fixed_frame, "camera_link", RigidTransform(), is_static=True
    )
    return stamp_ns, sample
