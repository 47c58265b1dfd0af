"""Where in the fixed frame did each beam of a scan end?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.containers.arrays import BoolArray, FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class LocatedScan:
    """A scan seen from above: its beams in the plane of the fixed frame, in the order they came.

    However the laser is mounted, upside down or tilted, this is where its beams went.

    Attributes:
        stamp_ns: When the first beam was measured.
        frame_id: The laser's frame.
        laser_xy_m: Shape (2,): where the laser was in the middle of the turn.
        xy_m: Shape (B, 2): where each beam ended; NaN without a return.
        range_m: Shape (B,): level distance from the laser to there; infinite where the scanner
            says that nothing is within its reach, NaN where it says nothing.
        heading_rad: Shape (B,): level direction of each beam from the x axis of the fixed frame,
            without a jump from one beam to the next.
        spacing_rad: From one beam to the next.
        range_max_m: Farthest range that counts.
        valid: Shape (B,): beams that ended at a height where people are.
        is_full_turn: Whether the beam after the last one is the first one again.
    """

    stamp_ns: int
    frame_id: str
    laser_xy_m: FloatArray
    xy_m: FloatArray
    range_m: FloatArray
    heading_rad: FloatArray
    spacing_rad: float
    range_max_m: float
    valid: BoolArray
    is_full_turn: bool

    def __len__(self) -> int:
        return len(self.range_m)

    @property
    def span_rad(self) -> tuple[float, float]:
        """Headings of the rightmost and the leftmost beam, each with half a spacing beside it."""
        right, left = sorted(self.heading_rad[[0, -1]].tolist())
        return right - self.spacing_rad / 2, left + self.spacing_rad / 2

    def returns_m(self, reach_m: float = np.inf) -> FloatArray:
        """Shape (R, 2): where valid beams ended, no farther from the laser than `reach_m`."""
        return self.xy_m[self.valid & (self.range_m <= reach_m)]
