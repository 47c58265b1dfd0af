"""What was the tracker given, frame by frame? Enough to run it again without pictures and scans.

Perception and ranging are what a recording costs. They run once; after that any number of trackers
may be held against the same measurements.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from numpy.typing import ArrayLike

from tracker.config import Config
from tracker.containers import Measurements, Tracks
from tracker.evaluation.recordings.recorded_frames import recorded_frames
from tracker.perception.detector import HandDetector
from tracker.pipeline import Pipeline
from tracker.recording import Topics
from tracker.tracking import PersonTracker, View
from tracker.tracking.trace import Watch


@dataclass(frozen=True, slots=True, eq=False)
class Step:
    """One call of `PersonTracker.step`.

    Attributes:
        stamp_ns: Of the measurements.
        measurements: In the fixed frame.
        robot_xy_m: Where the robot was.
        view: What its camera could see; None for everything.
        scan_view: What its laser could see; None without one.
        is_anew: Everybody is forgotten first.
    """

    stamp_ns: int
    measurements: Measurements
    robot_xy_m: tuple[float, float]
    view: View | None
    scan_view: View | None
    is_anew: bool = False


def recorded_steps(
    source: str | Path,
    config: Config | None = None,
    *,
    topics: Topics | None = None,
    stamps: str = "header",
    detector: HandDetector | None = None,
    progress: Callable[[float, int], None] = lambda share, images: None,
) -> tuple[Step, ...]:
    """Run a recording through perception and ranging, and keep what the tracker is given.

    A recording that breaks off counts as far as it goes.

    Args:
        source: Whatever `replay` reads.
        config: Every parameter.
        topics: Where in the recording the data are.
        stamps: "header" or "log": which of a message's times counts.
        detector: Finds hands; by default what `config.detector` names.
        progress: Told the share that is done, and how many images were processed.

    Raises:
        RecordingError: The source cannot be opened, or holds no image that could be processed.
        ModelFileError: The hand models are not there.
    """
    config = config or Config()
    pipeline = Pipeline(config, detector)
    pipeline.tracker = steps = _Steps(config)
    for _ in recorded_frames(source, pipeline, topics=topics, stamps=stamps, progress=progress):
        pass
    return tuple(steps.taken)


def run_steps(
    steps: Iterable[Step], config: Config, watch: Watch | None = None
) -> Iterator[Tracks]:
    """The same measurements through a tracker of their own, with other parameters."""
    tracker = PersonTracker(config, watch=watch)
    for step in steps:
        if step.is_anew:
            tracker.reset()
        yield tracker.step(
            step.stamp_ns,
            step.measurements,
            step.robot_xy_m,
            view=step.view,
            scan_view=step.scan_view,
        )


class _Steps(PersonTracker):
    """The tracker, which keeps what it is given."""

    def __init__(self, config: Config) -> None:
        super().__init__(config)
        self.taken: list[Step] = []
        self._is_anew = False

    def reset(self) -> None:
        super().reset()
        self._is_anew = True

    def step(
        self,
        stamp_ns: int,
        measurements: Measurements,
        robot_xy_m: ArrayLike = (0.0, 0.0),
        *,
        view: View | None = None,
        scan_view: View | None = None,
        **more: Any,
    ) -> Tracks:
        x_m, y_m = map(float, robot_xy_m)  # type: ignore[arg-type]  # the pipeline gives an array
        step = Step(stamp_ns, measurements, (x_m, y_m), view, scan_view, self._is_anew)
        self.taken.append(step)
        self._is_anew = False
        return super().step(
            stamp_ns, measurements, robot_xy_m, view=view, scan_view=scan_view, **more
        )
