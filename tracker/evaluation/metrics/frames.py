"""True and estimated positions of everybody at each frame of a trial."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray, Tracks, Truth


@dataclass(frozen=True, slots=True, eq=False)
class TruthFrames:
    """Everybody's truth over T frames; a column is one person.

    Attributes:
        stamps_ns: Shape (T,), ascending.
        id: Shape (P,): the person's number in the scene.
        xy_m: Shape (T, P, 2), in the fixed frame; NaN while somebody is not there.
        hand_up: Shape (T, P), bool.
        in_view: Shape (T, P), bool: that person's raised hand would fall into the picture.
    """

    stamps_ns: IntArray
    id: IntArray
    xy_m: FloatArray
    hand_up: BoolArray
    in_view: BoolArray

    @staticmethod
    def of(truths: Sequence[Truth]) -> TruthFrames:
        """One frame after the other, people by their numbers."""
        frame = np.repeat(np.arange(len(truths)), [len(truth) for truth in truths])
        people, column = np.unique(
            np.concatenate([truth.id for truth in truths]), return_inverse=True
        )
        shape = len(truths), len(people)
        xy_m = np.full((*shape, 2), np.nan)
        hand_up, in_view = np.zeros((2, *shape), dtype=bool)
        xy_m[frame, column] = np.concatenate([truth.xy_m for truth in truths])
        hand_up[frame, column] = np.concatenate([truth.hand_up for truth in truths])
        in_view[frame, column] = np.concatenate([truth.in_view for truth in truths])
        stamps_ns = np.array([truth.stamp_ns for truth in truths], dtype=np.int64)
        return TruthFrames(stamps_ns, people, xy_m, hand_up, in_view)

    def __iter__(self) -> Iterator[Truth]:
        for frame, is_there in enumerate(self.is_there):
            yield Truth(
                stamp_ns=int(self.stamps_ns[frame]),
                id=self.id[is_there],
                xy_m=self.xy_m[frame, is_there],
                hand_up=self.hand_up[frame, is_there],
                in_view=self.in_view[frame, is_there],
            )

    @property
    def is_there(self) -> BoolArray:
        """Shape (T, P)."""
        return np.isfinite(self.xy_m[..., 0])


@dataclass(frozen=True, slots=True, eq=False)
class TrackFrames:
    """The confirmed customers over T frames; columns fill from the left, by identity.

    Attributes:
        id: Shape (T, N); 0 where there is nobody.
        xy_m: Shape (T, N, 2), in the fixed frame; NaN where there is nobody.
        covariance_m2: Shape (T, N, 2, 2), of the position.
        raised: Shape (T, N), bool.
    """

    id: IntArray
    xy_m: FloatArray
    covariance_m2: FloatArray
    raised: BoolArray

    @staticmethod
    def of(frames: Sequence[Tracks]) -> TrackFrames:
        """One frame after the other; tentative tracks are left out."""
        confirmed = [tracks[tracks.confirmed] for tracks in frames]
        return TrackFrames.from_rows(
            np.array([len(tracks) for tracks in confirmed], dtype=np.int64),
            np.concatenate([tracks.id for tracks in confirmed]),
            np.concatenate([tracks.mean[:, :2] for tracks in confirmed]),
            np.concatenate([tracks.covariance[:, :2, :2] for tracks in confirmed]),
            np.concatenate([tracks.raised for tracks in confirmed]),
        )

    @staticmethod
    def from_rows(
        count: IntArray,
        track_id: IntArray,
        xy_m: FloatArray,
        covariance_m2: FloatArray,
        raised: BoolArray,
    ) -> TrackFrames:
        """Sort rows, one frame's behind the other's, into columns.

        Args:
            count: Shape (T,): how many rows are each frame's.
            track_id: Shape (R,), from 1.
            xy_m: Shape (R, 2).
            covariance_m2: Shape (R, 2, 2).
            raised: Shape (R,).
        """
        order = np.lexsort((track_id, np.repeat(np.arange(len(count)), count)))
        is_filled = np.arange(count.max(initial=0)) < count[:, None]
        frames = TrackFrames(
            np.zeros(is_filled.shape, dtype=np.int64),
            np.full((*is_filled.shape, 2), np.nan),
            np.zeros((*is_filled.shape, 2, 2)),
            np.zeros(is_filled.shape, dtype=bool),
        )
        frames.id[is_filled] = track_id[order]
        frames.xy_m[is_filled] = xy_m[order]
        frames.covariance_m2[is_filled] = covariance_m2[order]
        frames.raised[is_filled] = raised[order]
        return frames
