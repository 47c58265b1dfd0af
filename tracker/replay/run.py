"""Run the robot's pipeline on a recording.

Reads any recording, writes `output.mcap`, `tracks.csv`, `summary.json`, `overview.png` and
`debug.mp4`. Streams: memory does not grow with the recording.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from tracker.config import Config
from tracker.containers import CameraImage, FrameResult, OccupancyGrid, Scan, Truth
from tracker.errors import ClockError, OutputError, RecordingError, TransformError
from tracker.evaluation.metrics.raised_hands.episode_report import EpisodeReport
from tracker.evaluation.metrics.raised_hands.episodes import EpisodeEvaluation
from tracker.messages import Event
from tracker.outputs import FolderLock, check_inputs_stay
from tracker.perception.detector import HandDetector
from tracker.pipeline import Pipeline
from tracker.problems.problem_list import Problems
from tracker.recording import Recording, Topics, open_recording
from tracker.replay.outputs import ReplayOutputs, replay_files
from tracker.report.history.history import History
from tracker.report.plots.overview import draw_overview
from tracker.report.replay.summary import summarize, write_summary
from tracker.tracking.trace import Watch
from tracker.waiting import Verdict
from tracker.wording import listing

#: Told what share of the recording is done, from 0 to 1, and how many images were processed.
Progress = Callable[[float, int], None]

#: Told each processed image, what it led to, and the seconds of the wall's clock that took.
Watcher = Callable[[CameraImage, FrameResult, float], None]


@dataclass(frozen=True, slots=True, eq=False)
class Replay:
    """The result of a replay.

    Attributes:
        history: Everybody's tracks, raised hands and the room, for tables and pictures.
        summary: The content of `summary.json`.
        episodes: Reported against true raised hands; None where the recording holds no truth.
        problems: What was wrong with the input, one line each; empty where nothing was.
        remarks: What is worth saying and is no fault, one line each.
        files: What was written.
    """

    history: History
    summary: dict[str, object]
    episodes: EpisodeReport | None
    problems: tuple[str, ...]
    remarks: tuple[str, ...]
    files: tuple[Path, ...]


def replay(
    source: str | Path,
    out: str | Path,
    config: Config | None = None,
    *,
    topics: Topics | None = None,
    stamps: str = "header",
    room_map: OccupancyGrid | None = None,
    detector: HandDetector | None = None,
    progress: Progress | None = None,
    watch: Watch | None = None,
    watchers: Sequence[Watcher] = (),
) -> Replay:
    """Run the pipeline on a recording and write all results.

    A recording that breaks off, or holds broken messages, is replayed as far as it goes; what was
    wrong stands in `Replay.problems`, and everything written until then can be read.

    Args:
        source: rosbag2 folder, .mcap, .db3, ROS 1 .bag, video or folder of photos.
        out: Folder for the outputs; files of an earlier replay there are replaced.
        config: Every parameter.
        topics: Where in the recording the data are.
        stamps: "header" or "log": which of a message's times counts.
        room_map: A map of the room, in place of what the recording holds.
        detector: Finds hands; by default MediaPipe's models.
        progress: Told how far it is.
        watch: Passed on to the tracker, as an `innovation_log.InnovationLog`.
        watchers: Told of each image, as a live view or a report.

    Raises:
        RecordingError: The source cannot be opened or holds neither images nor scans, or the
            outputs cannot be written.
        ModelFileError: The hand models are not there.
        ConfigError: An output would replace the source, or another replay writes into `out`.
    """
    config, out = config or Config(), Path(out)
    problems = Problems()
    history = History(config)
    evaluation = EpisodeEvaluation()
    has_truth, frames_seen = False, 0
    check_inputs_stay([Path(source)], replay_files(out))
    with (
        open_recording(
            source,
            topics or Topics(),
            with_truth=True,
            stamps=stamps,
            max_pixels=config.picture_max_pixels,
        ) as recording,
        ExitStack() as held,
    ):
        if not recording.has_images:
            if not recording.has_scans or recording.image_topics:
                recording.require_images()
            problems.remark("no images in the recording: raised hands cannot be found")
        pipeline = Pipeline(config, detector, watch=watch, image_topic=recording.read_topics.image)
        held.enter_context(FolderLock(out))
        with ReplayOutputs(out, config) as outputs:

            def advance(now_ns: int | None = None) -> None:
                began_s = time.perf_counter()
                for image, result in pipeline.advance(now_ns):
                    busy_s = time.perf_counter() - began_s
                    outputs.write(image, result)
                    history.write(result)
                    evaluation.add_result(result)
                    problems.note_frame(result)
                    for watch in watchers:
                        watch(image, result, busy_s)
                    began_s = time.perf_counter()

            try:
                for log_ns, event in _with_map(recording.events(), room_map):
                    if isinstance(event, Truth):
                        evaluation.add_truth(event)
                        has_truth = True
                        continue
                    frames_seen += isinstance(event, CameraImage)
                    outputs.copy(log_ns, event)
                    _feed(pipeline, event, log_ns, problems)
                    advance(log_ns)
                    if progress is not None and isinstance(event, (CameraImage, Scan)):
                        progress(recording.share(log_ns), history.frames_processed)
            except OutputError:
                raise
            except RecordingError as error:  # breaks off: what came before it counts
                problems.add("broken recording", str(error))
            advance()
        _note_missing(pipeline, recording, history, problems, config)
        if recording.has_scans and config.depth_source != "depth":
            problems.note_scan_use(config.scan_max_age_s)
        if recording.has_depth and config.depth_source != "scan":
            problems.note_depth_use()
        for reason in recording.unread_lines():
            problems.add(reason, reason)
        for reason in recording.skipped_lines():
            problems.add(reason, reason)
        remarks = (*recording.notes, *problems.remarks())
        episodes = evaluation.report() if has_truth else None
        summary = summarize(history, frames_seen=frames_seen, evaluation=episodes) | {
            "source": str(source),
            "problems": list(problems.lines()),
            "remarks": list(remarks),
        }
        write_summary(summary, out / "summary.json")
        draw_overview(history, out / "overview.png", episodes)
        if progress is not None:
            progress(1.0, history.frames_processed)
        files = tuple(path for path in replay_files(out) if path.exists())
        return Replay(history, summary, episodes, problems.lines(), remarks, files)


def _with_map(
    events: Iterator[tuple[int, Event]], room_map: OccupancyGrid | None
) -> Iterator[tuple[int, Event]]:
    """What the sensors said, with the user's own map, if there is one, in place of theirs."""
    awaited = room_map
    for log_ns, event in events:
        if awaited is not None:
            yield log_ns, awaited
            awaited = None
        if room_map is None or not isinstance(event, OccupancyGrid):
            yield log_ns, event


def _feed(pipeline: Pipeline, event: Event, log_ns: int, problems: Problems) -> None:
    """Push one event into the pipeline, and keep what is wrong with it."""
    problems.note_arrival(event, log_ns)
    try:
        verdict = pipeline.add(event, log_ns)
    except (TransformError, ClockError) as error:
        problems.add("unusable transform", str(error))
        return
    if verdict is not None and verdict.is_refused and isinstance(event, CameraImage):
        text = f"image skipped: its stamp {event.stamp_ns / 1e9:.3f} s is {verdict.value}"
        if verdict is Verdict.LATE:
            problems.remark(text, kind=verdict.name)
        else:
            problems.add(verdict.name, text)


def _note_missing(
    pipeline: Pipeline,
    recording: Recording,
    history: History,
    problems: Problems,
    config: Config,
) -> None:
    """A bag whose frames never connect gives no pose: a problem of the input."""
    if not recording.is_bag or not history.frames_processed:
        return
    if not recording.has_scans and not recording.has_depth:
        problems.remark("no scans in the recording: raised hands have a bearing and no range")
    if config.depth_source == "depth" and not recording.has_depth:
        problems.add(
            "no depth",
            f"depth_source is depth, and no depth images are on {recording.read_topics.depth}: "
            "raised hands have a bearing and no range. Pass --depth-topic, or set depth_source.",
        )
    if len(history.camera_path):
        problems.note_poses()
        return
    late_s, wait_s = problems.transforms_late_s, config.transform_wait_s
    if late_s > wait_s:
        problems.add(
            "missing transforms",
            f"transforms were recorded {late_s:.3f} s later than images of the same stamp, which "
            f"wait for them {wait_s:g} s at most, so nobody has a pose. Raise transform_wait_s.",
        )
        return
    heard = listing(sorted(pipeline.transforms.frames)) or "none"
    problems.add(
        "missing transforms",
        f"no transform from {config.camera_frame!r} to {config.fixed_frame!r} at any image's "
        f"stamp, so nobody has a pose; known frames: {heard}. Set camera_frame and "
        f"fixed_frame, or fixed_frame: {config.camera_frame} to track relative to the camera.",
    )
