"""Was every raised hand reported, how soon, where, and as whom? Truth against tracks, as a stream.

Every processed image is compared with the truth sample nearest in time: confirmed tracks and
people are paired so that the sum of their distances is least, no pair farther apart than a cutoff.
An episode is a maximal interval in which a person's hand is up and in the camera's view.
"""

from __future__ import annotations

from array import array
from collections import deque
from dataclasses import dataclass

import numpy as np

from tracker.containers import FrameResult, IntArray, Tracks, Truth
from tracker.evaluation.metrics.matching import distances, match_best
from tracker.evaluation.metrics.raised_hands.episode_report import (
    EpisodeReport,
    EpisodeRow,
    InventedRow,
)
from tracker.evaluation.metrics.raised_hands.raise_reports import (
    Allowed,
    Compared,
    Episodes,
    judge_raises,
)

__all__ = ["EpisodeEvaluation", "EpisodeReport", "EpisodeRow", "InventedRow"]

_TRUTH_BUFFERED = 20_000  # samples: minutes without images, at 50 Hz
_RESULTS_BUFFERED = 1_000  # images: minutes without truth, at 10 Hz


class EpisodeEvaluation:
    """Compares truth and results as they come, each in order of its own stamps.

    Args:
        cutoff_m: No track is paired with a person farther away.
        raise_streak: Episodes with fewer images cannot be reported and are not missed.
        lower_streak: Images after the hand went down in which a track may still be raised ...
        transition_s: ... beginning this long after it went down; an arm takes time to fall, and to
            rise: a track raised this much too early is not invented either.
        truth_gap_s: A truth sample farther from an image's stamp says nothing about it.
        start_ns: Second 0 of the tables; the first stamp that comes where None.
    """

    def __init__(
        self,
        *,
        cutoff_m: float = 1.0,
        raise_streak: int = 2,
        lower_streak: int = 3,
        transition_s: float = 0.5,
        truth_gap_s: float = 0.1,
        start_ns: int | None = None,
    ) -> None:
        self._cutoff_m = cutoff_m
        self._allowed = Allowed(raise_streak, lower_streak, round(transition_s * 1e9))
        self._gap_ns = round(truth_gap_s * 1e9)
        self._start_ns = start_ns
        self._truth: deque[_Sample] = deque(maxlen=_TRUTH_BUFFERED)
        self._results: deque[FrameResult] = deque()
        self._open: dict[int, int] = {}
        self._episodes: list[_Episode] = []
        self._rows = _Rows()
        self._frames_without_truth = 0

    def add_truth(self, truth: Truth) -> None:
        """Take in where everybody really was at one instant."""
        if self._truth and truth.stamp_ns < self._truth[-1].truth.stamp_ns:
            self._finish_pending()  # the clock jumped back: what was belongs to nothing that comes
            self._truth.clear()
            self._open = {}
        self._begin(truth.stamp_ns)
        before, self._open = self._open, {}  # whoever has left has no hand up any more
        for row in np.flatnonzero(truth.hand_up & truth.in_view).tolist():
            person = int(truth.id[row])
            self._open[person] = before.get(person, len(self._episodes))
            if person not in before:
                x, y = truth.xy_m[row].tolist()
                self._episodes.append(_Episode(person, truth.stamp_ns, (x, y)))
            self._episodes[self._open[person]].end_ns = truth.stamp_ns
        self._truth.append(_Sample(truth, self._open))
        self._compare_ready()

    def add_result(self, result: FrameResult) -> None:
        """Take in what the pipeline made of one image."""
        if self._results and result.stamp_ns < self._results[-1].stamp_ns:
            self._finish_pending()
        self._begin(result.stamp_ns)
        self._results.append(result)
        self._compare_ready()

    def report(self) -> EpisodeReport:
        """Everything until now; may be asked at any time, best at the end."""
        self._finish_pending()
        return judge_raises(
            Episodes(
                np.array([episode.person for episode in self._episodes], dtype=np.int64),
                np.array([episode.start_ns for episode in self._episodes], dtype=np.int64),
                np.array([episode.end_ns for episode in self._episodes], dtype=np.int64),
                np.array([episode.xy_m for episode in self._episodes]).reshape(-1, 2),
            ),
            self._rows.compared(),
            self._allowed,
            start_ns=self._start_ns or 0,
            frames_without_truth=self._frames_without_truth,
        )

    def _begin(self, stamp_ns: int) -> None:
        if self._start_ns is None:
            self._start_ns = stamp_ns

    def _compare_ready(self) -> None:
        while self._results and (
            (self._truth and self._truth[-1].truth.stamp_ns >= self._results[0].stamp_ns)
            or len(self._results) > _RESULTS_BUFFERED
        ):
            self._compare_first()

    def _finish_pending(self) -> None:
        while self._results:
            self._compare_first()

    def _compare_first(self) -> None:
        result = self._results.popleft()
        truth = self._truth
        while len(truth) > 1 and truth[1].truth.stamp_ns <= result.stamp_ns:
            truth.popleft()
        near = sorted(
            (abs(sample.truth.stamp_ns - result.stamp_ns), row)
            for row, sample in enumerate((truth[0], truth[1]) if len(truth) > 1 else truth)
        )
        if not near or near[0][0] > self._gap_ns:
            self._frames_without_truth += 1
            return
        tracks = result.tracks[result.tracks.confirmed]
        self._rows.add(truth[near[0][1]], tracks, self._cutoff_m)


@dataclass(slots=True, eq=False)
class _Episode:
    person: int
    start_ns: int
    xy_m: tuple[float, float]
    end_ns: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class _Sample:
    """Truth at one instant, and the rows of the episodes that last there, by person."""

    truth: Truth
    open: dict[int, int]


class _Rows:
    """`Compared`, as it grows."""

    def __init__(self) -> None:
        self._stamps_ns = array("q")
        self._people = array("q")  # image, number, is the hand up, episode
        self._tracks = array("q")  # image, identity, row of the person
        self._places = array("d")  # x, y, how far from the person

    def add(self, sample: _Sample, tracks: Tracks, cutoff_m: float) -> None:
        """Compare one image with the truth; no pair is farther apart than the cutoff."""
        frame, truth, first = len(self._stamps_ns), sample.truth, len(self._people) // 4
        self._stamps_ns.append(tracks.stamp_ns)
        for person, is_up in zip(truth.id.tolist(), truth.hand_up.tolist(), strict=True):
            self._people.extend((frame, person, is_up, sample.open.get(person, -1)))
        apart = distances(tracks.mean[None, :, :2], truth.xy_m[None])
        (pairs,) = match_best(cutoff_m - apart)
        for row in np.flatnonzero(tracks.raised).tolist():
            at = int(pairs[row].argmax()) if pairs[row].any() else -1
            self._tracks.extend((frame, int(tracks.id[row]), first + at if at >= 0 else -1))
            error_m = float(apart[0, row, at]) if at >= 0 else np.inf
            self._places.extend((*tracks.mean[row, :2].tolist(), error_m))

    def compared(self) -> Compared:
        """The rows until now."""
        frame, person, is_up, episode = _table(self._people, 4).T
        track_frame, track, paired = _table(self._tracks, 3).T
        places = np.array(self._places).reshape(-1, 3)
        return Compared(
            stamps_ns=np.array(self._stamps_ns, dtype=np.int64),
            frame=frame,
            person=person,
            hand_up=is_up.astype(bool),
            episode=episode,
            track_frame=track_frame,
            track=track,
            paired=paired,
            xy_m=places[:, :2],
            error_m=places[:, 2],
        )


def _table(numbers: array[int], columns: int) -> IntArray:
    return np.array(numbers, dtype=np.int64).reshape(-1, columns)
