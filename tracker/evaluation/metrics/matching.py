"""Which track stands for which person? Many frames at once, each pair of a frame one to one."""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment

from tracker.containers import BoolArray, FloatArray, IntArray


def distances(tracks_xy_m: FloatArray, people_xy_m: FloatArray) -> FloatArray:
    """How far every track is from every person, in meters.

    Args:
        tracks_xy_m: Shape (T, N, 2); NaN where there is nobody.
        people_xy_m: Shape (T, P, 2), in the same frame; NaN where there is nobody.

    Returns:
        Shape (T, N, P); infinite where there is nobody.
    """
    x_m, y_m = np.moveaxis(tracks_xy_m[:, :, None] - people_xy_m[:, None], -1, 0)
    apart = np.asarray(np.sqrt(x_m * x_m + y_m * y_m))
    apart[np.isnan(apart)] = np.inf
    return apart


def match_best(gain: FloatArray) -> BoolArray:
    """Pair each frame at the highest sum of gains.

    Where everybody's best is nobody else's nothing can be better; only the other frames go through
    the Hungarian algorithm.

    Args:
        gain: Shape (T, N, P): what a pair is worth; one at 0 or below is never made.

    Returns:
        Shape (T, N, P): the pairs.
    """
    best = gain.max(axis=1, initial=0.0)[:, None]
    pairs: BoolArray = (gain == best) & (best > 0.0)
    is_disputed = (pairs.sum(axis=2) > 1).any(axis=1) | (pairs.sum(axis=1) > 1).any(axis=1)
    disputed = np.flatnonzero(is_disputed)
    pairs[disputed] = False
    for frame, worth in zip(disputed.tolist(), np.maximum(gain[disputed], 0.0), strict=True):
        row, column = linear_sum_assignment(worth, maximize=True)
        pairs[frame, row, column] = True
    return pairs & (gain > 0.0)


def match_faithfully(track_id: IntArray, gain: FloatArray) -> BoolArray:
    """Pair each frame as the CLEAR MOT metrics do.

    A pair of the last frame stays one while its gain is above 0, even where another would be
    better; the rest are paired at the highest sum of gains.

    Args:
        track_id: Shape (T, N); 0 where there is nobody.
        gain: Shape (T, N, P): as for `match_best`; a column is one person in all frames.

    Returns:
        Shape (T, N, P): the pairs.

    Source: Bernardin, Stiefelhagen, "Evaluating multiple object tracking performance: the CLEAR
        MOT metrics", EURASIP Journal on Image and Video Processing, 2008.
    """
    may_pair, pairs = gain > 0.0, np.zeros(gain.shape, dtype=bool)
    is_other = (track_id[1:] != track_id[:-1]).any(axis=1)
    ends = np.append(1 + np.flatnonzero(is_other), len(gain))  # of frames with the same tracks
    track_of = np.zeros(gain.shape[2], dtype=np.int64)  # who stands for each person; 0 for nobody
    frame = 0
    while frame < len(gain):
        kept = (track_id[frame][:, None] == track_of) & (track_of > 0) & may_pair[frame]
        rest = np.where(_is_free(kept), gain[frame], 0.0)
        now = kept | match_best(rest[None])[0] if rest.any() else kept
        track_of = (now * track_id[frame][:, None]).sum(axis=0)
        # The same while every pair may stay and no two who are left may be paired.
        ahead = may_pair[frame : ends[np.searchsorted(ends, frame, side="right")]]
        is_same = ahead[:, now].all(axis=1) & ~ahead[:, _is_free(now)].any(axis=1)
        last = frame + (len(ahead) if is_same.all() else int(is_same.argmin()))
        pairs[frame:last] = now
        frame = last
    return pairs


def _is_free(pairs: BoolArray) -> BoolArray:
    """Shape (N, P): neither the track nor the person is in a pair."""
    return np.asarray(~(pairs.any(axis=1, keepdims=True) | pairs.any(axis=0, keepdims=True)))
