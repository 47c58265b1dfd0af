"""Does the pipeline follow real people's calls through video clips? Against labeled episodes."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tracker.config import Config
from tracker.containers import FrameResult
from tracker.errors import RecordingError
from tracker.evaluation.detection.photo_study import Share, share_of
from tracker.evaluation.recordings.recorded_frames import recorded_frames
from tracker.pipeline import Pipeline

EPISODES = "episodes.csv"
#: A streak lets a raised hand go a little late: so much after an episode is still its own, s.
_AFTER_S = 0.5
Play = Callable[[Path], Iterable[FrameResult]]


@dataclass(frozen=True, slots=True)
class LabeledClip:
    """A video and the times in which a hand is up.

    Attributes:
        path: The video.
        episodes_s: From and to, of each raised hand, seconds from the start; none where nobody
            calls.
    """

    path: Path
    episodes_s: tuple[tuple[float, float], ...]

    @property
    def calls_s(self) -> tuple[tuple[float, float], ...]:
        """The same, with those that overlap joined: somebody raises a second hand, too."""
        calls: list[tuple[float, float]] = []
        for start_s, end_s in sorted(self.episodes_s):
            if calls and start_s <= calls[-1][1]:
                start_s, end_s = calls[-1][0], max(end_s, calls.pop()[1])
            calls.append((start_s, end_s))
        return tuple(calls)


@dataclass(frozen=True, slots=True)
class JudgedClip:
    """What the pipeline made of one clip.

    Attributes:
        clip: With its labels.
        duration_s: Of the images that were processed.
        images_up: Images in which a hand is up.
        images_raised: Of these, those in which somebody was raised.
        raises: Times that raised began.
        false_raises: Of these, those outside of every episode.
        identities: Tracks that were raised.
        delays_s: From the begin of each call to its first raised image; NaN where none came.
    """

    clip: LabeledClip
    duration_s: float
    images_up: int
    images_raised: int
    raises: int
    false_raises: int
    identities: int
    delays_s: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class ClipStudy:
    """What became of the clips, in the order of the labels."""

    clips: tuple[JudgedClip, ...]

    @property
    def shares(self) -> tuple[Share, ...]:
        """The totals."""
        called = [item for item in self.clips if item.clip.episodes_s]
        found = sum(int(np.isfinite(item.delays_s).sum()) for item in called)
        return (
            share_of("calls found", found, sum(len(item.delays_s) for item in called)),
            share_of(
                "images with a hand up in which somebody was raised",
                sum(item.images_raised for item in called),
                sum(item.images_up for item in called),
            ),
        )

    @property
    def false_raises(self) -> tuple[int, float]:
        """How many, and in how many seconds without a call."""
        count = sum(item.false_raises for item in self.clips)
        idle_s = sum(
            item.duration_s - sum(end_s - start_s for start_s, end_s in item.clip.calls_s)
            for item in self.clips
        )
        return count, max(idle_s, 0.0)


def read_clips(folder: str | Path) -> tuple[LabeledClip, ...]:
    """Read `clips/episodes.csv` of a folder: clip, start_s, end_s; other columns are free.

    A row for each raised hand; a clip in which nobody calls has one row without times.

    Args:
        folder: Holds `clips`; without it there are none.

    Raises:
        RecordingError: A row is off, or a clip is not there; the message names the line.
    """
    path = Path(folder) / "clips" / EPISODES
    if not path.is_file():
        return ()
    episodes: dict[Path, list[tuple[float, float]]] = {}
    with path.open(newline="", encoding="utf-8-sig") as file:
        reader = csv.DictReader(file, skipinitialspace=True, restval="")
        if not {"clip", "start_s", "end_s"} <= set(reader.fieldnames or ()):
            raise RecordingError(f"{path}: line 1: expected the columns clip,start_s,end_s.")
        for row in reader:
            where = f"{path}: line {reader.line_num}"
            clip = path.parent / row["clip"]
            if not row["clip"] or not clip.is_file():
                raise RecordingError(
                    f"{where}: there is no clip {row['clip']!r} in {clip.parent}."
                )
            spans = episodes.setdefault(clip, [])
            if row["start_s"] or row["end_s"]:
                spans.append(_span(row["start_s"], row["end_s"], where))
    return tuple(LabeledClip(clip, tuple(spans)) for clip, spans in episodes.items())


def study_clips(
    clips: Iterable[LabeledClip],
    config: Config,
    *,
    play: Play | None = None,
    progress: Callable[[int], None] = lambda number: None,
) -> ClipStudy:
    """Send each clip through a pipeline of its own.

    Args:
        clips: With their labels.
        config: The pipeline's parameters.
        play: Gives the result of each image of a video; by default the pipeline does.
        progress: Told how many clips are done.

    Raises:
        RecordingError: A clip holds no image that could be processed.
    """

    def play_through(path: Path) -> Iterator[FrameResult]:
        return recorded_frames(path, Pipeline(config))

    judged = []
    for number, clip in enumerate(clips, start=1):
        judged.append(judge_clip(clip, (play or play_through)(clip.path)))
        progress(number)
    return ClipStudy(tuple(judged))


def judge_clip(clip: LabeledClip, results: Iterable[FrameResult]) -> JudgedClip:
    """Compare one clip's results with its episodes.

    Args:
        clip: With its labels.
        results: Of its images, in order; the first is second 0.
    """
    times, raised, identities = [], [], set[int]()
    for result in results:
        times.append(result.stamp_ns)
        raised.append(result.hand_raised)
        identities |= set(result.tracks.id[result.tracks.raised].tolist())
    at_s = (np.array(times, dtype=np.int64) - (times[0] if times else 0)) / 1e9
    is_raised = np.array(raised, dtype=bool)
    is_up, is_known = np.zeros(len(at_s), dtype=bool), np.zeros(len(at_s), dtype=bool)
    delays_s = []
    for start_s, end_s in clip.calls_s:
        within = (at_s >= start_s) & (at_s <= end_s)
        is_up |= within
        is_known |= (at_s >= start_s) & (at_s <= end_s + _AFTER_S)
        hits = at_s[within & is_raised]
        delays_s.append(float(hits[0] - start_s) if len(hits) else float("nan"))
    begins = is_raised & ~np.append(False, is_raised[:-1])
    return JudgedClip(
        clip,
        float(at_s[-1]) if len(at_s) else 0.0,
        int(is_up.sum()),
        int((is_raised & is_up).sum()),
        int(begins.sum()),
        int((begins & ~is_known).sum()),
        len(identities),
        tuple(delays_s),
    )


def clips_as_dict(study: ClipStudy) -> dict[str, Any]:
    """A study in plain numbers, fit for JSON; None for what was not measured."""
    count, idle_s = study.false_raises
    return {
        "totals": [
            {"name": item.name, "count": item.count, "total": item.total} for item in study.shares
        ],
        "false_raises": count,
        "seconds_without_a_call": idle_s,
        "clips": [
            {
                "clip": item.clip.path.name,
                "calls": len(item.delays_s),
                "images_with_a_hand_up": item.images_up,
                "raised_in": item.images_raised,
                "raises": item.raises,
                "false_raises": item.false_raises,
                "identities": item.identities,
                "delays_s": [None if np.isnan(delay) else delay for delay in item.delays_s],
            }
            for item in study.clips
        ],
    }


def _span(start: str, end: str, where: str) -> tuple[float, float]:
    try:
        start_s, end_s = float(start), float(end)
    except ValueError as error:
        raise RecordingError(
            f"{where}: start_s, end_s are {start!r}, {end!r}; expected seconds, or neither."
        ) from error
    if not 0.0 <= start_s < end_s < np.inf:
        raise RecordingError(f"{where}: start_s, end_s are {start_s:g}, {end_s:g}; swap them.")
    return start_s, end_s
