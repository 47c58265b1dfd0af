"""Was every raised hand of a trial reported? `episodes` where every frame has its truth."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray, IntArray
from tracker.evaluation.metrics.frames import TrackFrames, TruthFrames
from tracker.evaluation.metrics.matching import match_best
from tracker.evaluation.metrics.raised_hands.episode_report import EpisodeReport
from tracker.evaluation.metrics.raised_hands.raise_reports import (
    Allowed,
    Compared,
    Episodes,
    judge_raises,
)


def judge_trial(
    truth: TruthFrames,
    tracks: TrackFrames,
    apart_m: FloatArray,
    cutoff_m: float,
    allowed: Allowed,
) -> EpisodeReport:
    """What `EpisodeEvaluation` finds where each frame is an image and a sample of the truth.

    Args:
        truth: Everybody who is there.
        tracks: Whom the tracker knows.
        apart_m: Shape (T, N, P): how far every track is from every person.
        cutoff_m: No track is paired with a person farther away.
        allowed: What counts as invented.
    """
    episodes, episode = _episodes(truth)
    frame, column = np.nonzero(truth.is_there)
    row, error_m = _pairs(truth, apart_m, cutoff_m)
    raised = np.nonzero(tracks.raised)
    compared = Compared(
        stamps_ns=truth.stamps_ns,
        frame=frame,
        person=truth.id[column],
        hand_up=truth.hand_up[frame, column],
        episode=episode[frame, column],
        track_frame=raised[0],
        track=tracks.id[raised],
        paired=row[raised],
        xy_m=tracks.xy_m[raised],
        error_m=error_m[raised],
    )
    return judge_raises(episodes, compared, allowed, start_ns=int(truth.stamps_ns[0]))


def _episodes(truth: TruthFrames) -> tuple[Episodes, IntArray]:
    """Every episode, and the row of the one that lasts, shape (T, P), or -1."""
    lasts = (truth.hand_up & truth.in_view & truth.is_there).T
    before, after = np.zeros((2, *lasts.shape), dtype=bool)
    before[:, 1:], after[:, :-1] = lasts[:, :-1], lasts[:, 1:]
    begins = lasts & ~before
    column, first = np.nonzero(begins)
    last = np.nonzero(lasts & ~after)[1]
    episodes = Episodes(
        person=truth.id[column],
        start_ns=truth.stamps_ns[first],
        end_ns=truth.stamps_ns[last],
        xy_m=truth.xy_m[first, column],
    )
    number = np.cumsum(begins).reshape(begins.shape) - 1
    return episodes, np.where(lasts, number, -1).T


def _pairs(
    truth: TruthFrames, apart_m: FloatArray, cutoff_m: float
) -> tuple[IntArray, FloatArray]:
    """Row of the person at whom each track stands, or -1, and how far; shape (T, N)."""
    is_there = truth.is_there
    row_of = np.cumsum(is_there).reshape(is_there.shape) - 1
    frame, place, column = np.nonzero(match_best(cutoff_m - apart_m))
    row, error_m = np.full(apart_m.shape[:2], -1), np.full(apart_m.shape[:2], np.inf)
    row[frame, place] = row_of[frame, column]
    error_m[frame, place] = apart_m[frame, place, column]
    return row, error_m
