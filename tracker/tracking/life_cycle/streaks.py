"""Is the hand up? Two detections in a row say yes, three misses in a row say no (algorithm 1)."""

from __future__ import annotations

from tracker.compiling.loops import loop
from tracker.containers import BoolArray, IntArray
from tracker.tracking.people import DETECTED, MISSED, RAISED


@loop
def step_streak(
    counts: IntArray,
    flags: BoolArray,
    person: int,
    is_detected: bool,
    raise_streak: float,
    lower_streak: float,
) -> None:
    """Count one image for one track, in place.

    Args:
        counts: Shape (10, N), of `People`: consecutive images with and without a raised hand.
        flags: Shape (2, N), of `People`: whether the hand counts as raised.
        person: The track's row.
        is_detected: A raised hand was assigned to the track.
        raise_streak: Detections in a row that raise.
        lower_streak: Misses in a row that lower.
    """
    if is_detected:
        counts[DETECTED, person] += 1
        counts[MISSED, person] = 0
        if counts[DETECTED, person] >= raise_streak:
            flags[RAISED, person] = True
    else:
        counts[DETECTED, person] = 0
        counts[MISSED, person] += 1
    if counts[MISSED, person] >= lower_streak:
        flags[RAISED, person] = False
