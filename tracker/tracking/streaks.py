"""Is the hand up? Two detections in a row say yes, three misses in a row say no (algorithm 1)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.containers import BoolArray, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Streaks:
    """The specification's streak counters, one row for each track.

    Attributes:
        detected: Shape (N,): consecutive frames with a raised hand.
        missed: Shape (N,): consecutive frames without one.
        raised: Shape (N,), bool: the streaks' word.
    """

    detected: IntArray
    missed: IntArray
    raised: BoolArray

    @staticmethod
    def begin(count: int) -> Streaks:
        """Counters of tracks that have seen nothing yet."""
        zero = np.zeros(count, dtype=np.int64)
        return Streaks(zero, zero, np.zeros(count, dtype=bool))

    def step(self, is_detected: BoolArray, raise_streak: int, lower_streak: int) -> Streaks:
        """Count one processed frame.

        Args:
            is_detected: Shape (N,): a raised hand was assigned to the track.
            raise_streak: Detections in a row that raise.
            lower_streak: Misses in a row that lower.
        """
        detected = np.where(is_detected, self.detected + 1, 0)
        missed = np.where(is_detected, 0, self.missed + 1)
        raised = np.where(is_detected, self.raised | (detected >= raise_streak), self.raised)
        raised &= ~(missed >= lower_streak)
        return Streaks(detected, missed, raised)

    def __getitem__(self, rows: BoolArray) -> Streaks:
        return Streaks(self.detected[rows], self.missed[rows], self.raised[rows])

    def append(self, other: Streaks) -> Streaks:
        """Rows of both, in order."""
        return Streaks(
            np.concatenate([self.detected, other.detected]),
            np.concatenate([self.missed, other.missed]),
            np.concatenate([self.raised, other.raised]),
        )
