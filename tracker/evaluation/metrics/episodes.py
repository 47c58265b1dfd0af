"""Was every raised hand reported, how soon, where, and as whom? Truth against tracks, as a stream.

Every processed image is compared with the truth sample nearest in time: confirmed tracks and
people are paired so that the sum of their distances is least, no pair farther apart than a cutoff.
An episode is a maximal interval in which a person's hand is up and in the camera's view.
"""

from __future__ import annotations

from array import array
from collections import deque
from dataclasses import dataclass, field

import numpy as np

from tracker.containers import FloatArray, FrameResult, Tracks, Truth
from tracker.evaluation.metrics.episode_report import EpisodeReport, EpisodeRow, InventedRow

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
        self._raise_streak = raise_streak
        self._lower_streak = lower_streak
        self._transition_ns = round(transition_s * 1e9)
        self._gap_ns = round(truth_gap_s * 1e9)
        self._start_ns = start_ns
        self._truth: deque[_Sample] = deque(maxlen=_TRUTH_BUFFERED)
        self._results: deque[FrameResult] = deque()
        self._open: dict[int, _Episode] = {}
        self._episodes: list[_Episode] = []
        self._last_up_ns: dict[int, int] = {}
        self._frames_down: dict[int, int] = {}
        self._unfounded: dict[int, _Unfounded] = {}
        self._invented: list[InventedRow] = []
        self._identities: dict[int, list[int]] = {}
        self._reported_as: dict[int, int] = {}
        self._switches = 0
        self._errors = _Errors()
        self._frames = 0
        self._frames_without_truth = 0

    def add_truth(self, truth: Truth) -> None:
        """Take in where everybody really was at one instant."""
        if self._truth and truth.stamp_ns < self._truth[-1].truth.stamp_ns:
            self._finish_pending()  # the clock jumped back: what was belongs to nothing that comes
            self._truth.clear()
            self._open.clear()
            self._last_up_ns.clear()
            self._frames_down.clear()
        self._begin(truth.stamp_ns)
        counted = truth.hand_up & truth.in_view
        for row, person in enumerate(truth.id.tolist()):
            if not counted[row]:
                self._open.pop(person, None)
                continue
            if person not in self._open:
                x, y = truth.xy_m[row].tolist()
                self._open[person] = episode = _Episode(person, truth.stamp_ns, (x, y))
                self._episodes.append(episode)
            self._open[person].end_ns = truth.stamp_ns
        self._truth.append(_Sample(truth, dict(self._open)))
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
        rows = [episode.row() for episode in self._episodes]
        told = [
            row for row in rows if row.reported_ns is not None or row.frames >= self._raise_streak
        ]
        invented = [*self._invented, *(item.row() for item in self._unfounded.values())]
        return EpisodeReport(
            start_ns=self._start_ns or 0,
            episodes=tuple(sorted(told, key=lambda row: (row.start_ns, row.person))),
            invented=tuple(sorted(invented, key=lambda row: (row.start_ns, row.identity))),
            too_short=len(rows) - len(told),
            identities={key: tuple(ids) for key, ids in sorted(self._identities.items())},
            identity_switches=self._switches,
            position_error_m=self._errors.median(),
            frames=self._frames,
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
        self._frames += 1
        self._compare(truth[near[0][1]], result.tracks[result.tracks.confirmed])

    def _compare(self, sample: _Sample, tracks: Tracks) -> None:
        truth, now_ns = sample.truth, tracks.stamp_ns
        for episode in sample.open.values():
            episode.frames += 1
        for row, person in enumerate(truth.id.tolist()):
            if truth.hand_up[row]:
                self._last_up_ns[person], self._frames_down[person] = now_ns, 0
            elif now_ns - self._last_up_ns.get(person, now_ns) > self._transition_ns:
                self._frames_down[person] += 1
        pairs = _pair(tracks.mean[:, :2], truth.xy_m, self._cutoff_m)
        for row in np.flatnonzero(tracks.raised).tolist():
            identity, at = int(tracks.id[row]), pairs.get(row)
            person = None if at is None else int(truth.id[at])
            if person is None or self._frames_down.get(person, self._lower_streak) >= (
                self._lower_streak
            ):
                x, y = tracks.mean[row, :2].tolist()
                first = _Unfounded(identity, now_ns, now_ns, (x, y), person)
                self._unfounded.setdefault(identity, first).end_ns = now_ns
                continue
            early = self._unfounded.pop(identity, None)
            if early is not None and now_ns - early.start_ns > self._transition_ns:
                self._invented.append(early.row())
            if truth.hand_up[at]:
                error_m = float(np.linalg.norm(tracks.mean[row, :2] - truth.xy_m[at]))
                self._credit(person, identity, error_m, now_ns, sample.open.get(person))
        raised = set(tracks.id[tracks.raised].tolist())
        for identity in [key for key in self._unfounded if key not in raised]:
            self._invented.append(self._unfounded.pop(identity).row())

    def _credit(
        self, person: int, identity: int, error_m: float, now_ns: int, episode: _Episode | None
    ) -> None:
        self._errors.add(error_m)
        identities = self._identities.setdefault(person, [])
        if identity not in identities:
            identities.append(identity)
        self._switches += int(self._reported_as.get(person, identity) != identity)
        self._reported_as[person] = identity
        if episode is not None:
            episode.errors.add(error_m)
            if identity not in episode.identities:
                episode.identities.append(identity)
            if episode.reported_ns is None:
                episode.reported_ns = max(now_ns, episode.start_ns)
                episode.reported_frames = episode.frames


def _pair(tracks_xy: FloatArray, people_xy: FloatArray, cutoff_m: float) -> dict[int, int]:
    """Rows of tracks to rows of people: least sum of distances, each below the cutoff."""
    from scipy.optimize import linear_sum_assignment

    distance = np.linalg.norm(tracks_xy[:, None] - people_xy[None], axis=-1)
    # Capped: leaving both alone costs the cutoff, so that no far pair is forced on anybody.
    rows, columns = linear_sum_assignment(np.minimum(distance, cutoff_m))
    near = distance[rows, columns] < cutoff_m
    return dict(zip(rows[near].tolist(), columns[near].tolist(), strict=True))


class _Errors:
    """Distances whose median is wanted; every second one leaves when there are too many."""

    def __init__(self) -> None:
        self._values = array("d")
        self._stride = 1
        self._count = 0

    def add(self, value: float) -> None:
        if self._count % self._stride == 0:
            self._values.append(value)
        self._count += 1
        if len(self._values) > 4096:
            self._values = self._values[::2]
            self._stride *= 2

    def median(self) -> float | None:
        return float(np.median(self._values)) if self._values else None


@dataclass(slots=True, eq=False)
class _Episode:
    person: int
    start_ns: int
    xy_m: tuple[float, float]
    end_ns: int = 0
    frames: int = 0
    reported_ns: int | None = None
    reported_frames: int | None = None
    identities: list[int] = field(default_factory=list)
    errors: _Errors = field(default_factory=_Errors)

    def row(self) -> EpisodeRow:
        return EpisodeRow(
            self.person, self.start_ns, self.end_ns, self.xy_m, self.frames,
            self.reported_ns, self.reported_frames, self.errors.median(), tuple(self.identities),
        )  # fmt: skip


@dataclass(slots=True, eq=False)
class _Unfounded:
    """A track that is raised while no raised hand stands behind it."""

    identity: int
    start_ns: int
    end_ns: int
    xy_m: tuple[float, float]
    person: int | None

    def row(self) -> InventedRow:
        return InventedRow(self.identity, self.start_ns, self.end_ns, self.xy_m, self.person)


@dataclass(frozen=True, slots=True, eq=False)
class _Sample:
    """Truth at one instant, and the episodes that last there, by person."""

    truth: Truth
    open: dict[int, _Episode]
