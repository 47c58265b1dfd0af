"""Which reports of a raised hand had a hand behind them? Rows of many images, judged at once."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray
from tracker.evaluation.metrics.raised_hands.episode_report import (
    EpisodeReport,
    EpisodeRow,
    InventedRow,
)


@dataclass(frozen=True, slots=True, eq=False)
class Episodes:
    """Maximal intervals in which a person's hand was up and in the camera's view.

    Attributes:
        person: Shape (E,): the person's number in the truth.
        start_ns: Shape (E,): first truth sample with the hand up and in view.
        end_ns: Shape (E,): last one.
        xy_m: Shape (E, 2): where the person stood at the start.
    """

    person: IntArray
    start_ns: IntArray
    end_ns: IntArray
    xy_m: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Compared:
    """F images beside the truth: a row for each person, and one for each raised track.

    Attributes:
        stamps_ns: Shape (F,), of the images.
        frame: Shape (K,), ascending: the image of a person's row.
        person: Shape (K,): the person's number in the truth.
        hand_up: Shape (K,), bool.
        episode: Shape (K,): row of the episode that lasts, or -1.
        track_frame: Shape (R,), ascending: the image of a raised track's row.
        track: Shape (R,): its identity.
        paired: Shape (R,): row of the person at whom it stands, or -1.
        xy_m: Shape (R, 2): where it is.
        error_m: Shape (R,): how far from that person.
    """

    stamps_ns: IntArray
    frame: IntArray
    person: IntArray
    hand_up: BoolArray
    episode: IntArray
    track_frame: IntArray
    track: IntArray
    paired: IntArray
    xy_m: FloatArray
    error_m: FloatArray


@dataclass(frozen=True, slots=True)
class Allowed:
    """How late, or early, may a report be?

    Attributes:
        raise_streak: Episodes with fewer images cannot be reported and are not missed.
        lower_streak: Images after the hand went down in which a track may still be raised ...
        transition_ns: ... beginning this long after it went down; an arm takes time to fall, and
            to rise: a track raised this much too early is not invented either.
    """

    raise_streak: int = 2
    lower_streak: int = 3
    transition_ns: int = 500_000_000


def judge_raises(
    episodes: Episodes,
    compared: Compared,
    allowed: Allowed,
    *,
    start_ns: int,
    frames_without_truth: int = 0,
) -> EpisodeReport:
    """Sum up what was compared.

    Args:
        episodes: In any order.
        compared: Images in the order in which they came.
        allowed: What counts as invented.
        start_ns: Second 0 of the tables.
        frames_without_truth: Passed on.
    """
    is_founded = _is_founded(compared, allowed)
    credited = np.flatnonzero(is_founded)
    credited = credited[compared.hand_up[compared.paired[credited]]]
    identities, switches = _identities(compared, credited)
    rows = _episode_rows(episodes, compared, credited)
    told = [
        row for row in rows if row.reported_ns is not None or row.frames >= allowed.raise_streak
    ]
    invented = _invented(compared, is_founded, allowed)
    return EpisodeReport(
        start_ns=start_ns,
        episodes=tuple(sorted(told, key=lambda row: (row.start_ns, row.person))),
        invented=tuple(sorted(invented, key=lambda row: (row.start_ns, row.identity))),
        too_short=len(rows) - len(told),
        identities=identities,
        identity_switches=switches,
        position_error_m=_median(compared.error_m[credited]),
        frames=len(compared.stamps_ns),
        frames_without_truth=frames_without_truth,
    )


def _is_founded(compared: Compared, allowed: Allowed) -> BoolArray:
    """Shape (R,): the track stands at somebody whose hand is up, or has not been down for long."""
    at = compared.paired
    down = _frames_down(compared, allowed)
    founded = at >= 0
    founded[founded] = down[at[founded]] < allowed.lower_streak
    return founded


def _frames_down(compared: Compared, allowed: Allowed) -> IntArray:
    """Shape (K,): images since the arm had time to fall; as many as matter if it was never up."""
    # Where the clock jumped back, what was before says nothing.
    jumps = np.cumsum(np.diff(compared.stamps_ns, prepend=compared.stamps_ns[:1]) < 0)
    order = np.lexsort((compared.person, jumps[compared.frame]))
    jump, person = jumps[compared.frame][order], compared.person[order]
    now_ns, is_up = compared.stamps_ns[compared.frame][order], compared.hand_up[order]
    row = np.arange(len(order))
    begins = np.ones(len(order), dtype=bool)
    begins[1:] = (person[1:] != person[:-1]) | (jump[1:] != jump[:-1])
    last_up = np.maximum.accumulate(np.where(is_up, row, -1))
    was_up = last_up >= np.maximum.accumulate(np.where(begins, row, 0))
    counts = was_up & (now_ns - now_ns[last_up] > allowed.transition_ns)
    total = np.cumsum(counts)
    down = np.empty(len(order), dtype=np.int64)
    down[order] = np.where(was_up, total - total[last_up], allowed.lower_streak)
    return down


def _invented(compared: Compared, is_founded: BoolArray, allowed: Allowed) -> list[InventedRow]:
    """One row for each uninterrupted time in which a track was raised for no reason."""
    order = np.argsort(compared.track, kind="stable")
    frame, track, is_unfounded = (
        values[order] for values in (compared.track_frame, compared.track, ~is_founded)
    )
    goes_on = np.zeros(len(order) + 1, dtype=bool)  # the row is the next image of the one before
    goes_on[1:-1] = (track[1:] == track[:-1]) & (frame[1:] == frame[:-1] + 1)
    before, after = np.zeros((2, len(order)), dtype=bool)
    before[1:], after[:-1] = is_unfounded[:-1], is_unfounded[1:]
    first = np.flatnonzero(is_unfounded & ~(goes_on[:-1] & before))
    last = np.flatnonzero(is_unfounded & ~(goes_on[1:] & after))
    rows = []
    for one, other in zip(first.tolist(), last.tolist(), strict=True):
        start_ns = int(compared.stamps_ns[frame[one]])
        if goes_on[other + 1]:  # a hand came up behind it
            reason_ns = int(compared.stamps_ns[frame[other + 1]])
            if reason_ns - start_ns <= allowed.transition_ns:
                continue
        row = order[one]
        at = compared.paired[row]
        x, y = compared.xy_m[row].tolist()
        end_ns = int(compared.stamps_ns[frame[other]])
        person = None if at < 0 else int(compared.person[at])
        rows.append(InventedRow(int(track[one]), start_ns, end_ns, (x, y), person))
    return rows


def _identities(compared: Compared, credited: IntArray) -> tuple[dict[int, tuple[int, ...]], int]:
    """The tracks that reported each person's hand, in order, and how often they changed."""
    person = compared.person[compared.paired[credited]]
    order = np.argsort(person, kind="stable")
    person, track = person[order], compared.track[credited][order]
    is_other = np.ones(len(order), dtype=bool)
    is_other[1:] = person[1:] != person[:-1]
    people = int(np.count_nonzero(is_other))
    is_other[1:] |= track[1:] != track[:-1]
    told: dict[int, dict[int, None]] = {}
    for who, identity in zip(person[is_other].tolist(), track[is_other].tolist(), strict=True):
        told.setdefault(who, {})[identity] = None
    switches = int(np.count_nonzero(is_other)) - people
    return {who: tuple(ids) for who, ids in told.items()}, switches


def _episode_rows(episodes: Episodes, compared: Compared, credited: IntArray) -> list[EpisodeRow]:
    count = len(episodes.person)
    frames = np.bincount(compared.episode[compared.episode >= 0], minlength=count)
    # Which image of its episode a person's row is, from 1.
    order = np.argsort(compared.episode, kind="stable")
    number = np.empty(len(order), dtype=np.int64)
    begin = np.searchsorted(compared.episode[order], np.arange(count))
    number[order] = np.arange(1, len(order) + 1) - np.append(begin, 0)[compared.episode[order]]

    episode = compared.episode[compared.paired[credited]]
    credited = credited[np.argsort(episode, kind="stable")]
    ends = np.searchsorted(np.sort(episode), np.arange(count + 1)).tolist()
    rows = []
    for row, (begin_at, end_at) in enumerate(pairwise(ends)):
        reports = credited[begin_at:end_at]
        start_ns = int(episodes.start_ns[row])
        reported_ns = reported_frames = None
        if len(reports):
            now_ns = int(compared.stamps_ns[compared.track_frame[reports[0]]])
            reported_ns = max(now_ns, start_ns)
            reported_frames = int(number[compared.paired[reports[0]]])
        x, y = episodes.xy_m[row].tolist()
        rows.append(
            EpisodeRow(
                person=int(episodes.person[row]),
                start_ns=start_ns,
                end_ns=int(episodes.end_ns[row]),
                xy_m=(x, y),
                frames=int(frames[row]),
                reported_ns=reported_ns,
                reported_frames=reported_frames,
                position_error_m=_median(compared.error_m[reports]),
                identities=tuple(dict.fromkeys(compared.track[reports].tolist())),
            )
        )
    return rows


def _median(values: FloatArray) -> float | None:
    return float(np.median(values)) if len(values) else None
