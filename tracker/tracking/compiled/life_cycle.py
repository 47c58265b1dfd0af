"""Who is a customer, who is gone, whose hand is up? `life_cycle` and `streaks` as loops."""

from __future__ import annotations

import numpy as np
from numba import njit

from tracker.containers import BoolArray, FloatArray, IntArray
from tracker.tracking.compiled.settings import Settings
from tracker.tracking.life_cycle import EXISTENCE_MIN, LOG_EVIDENCE_MAX


@njit(error_model="numpy")
def believe(existence: FloatArray, chosen: IntArray, odds: FloatArray, chance: FloatArray) -> None:
    """Bayes' rule on existence, in place: `life_cycle.believe`.

    Args:
        existence: Shape (N,).
        chosen: Shape (N,): row of each one's pair, or -1.
        odds: Shape (P,): log-odds of the pairs.
        chance: Shape (N,): of being detected.
    """
    for person in range(len(existence)):
        evidence = 0.0
        if chosen[person] >= 0:
            evidence = odds[chosen[person]] + np.log(1.0 - chance[person])
        ratio = np.exp(min(max(evidence, 0.0), LOG_EVIDENCE_MAX))
        ratio *= existence[person] / (1.0 - existence[person])
        existence[person] = min(ratio / (1.0 + ratio), 1.0 - 1e-6)


@njit(error_model="numpy")
def count_detections(
    is_called: BoolArray,
    is_seen: BoolArray,
    stamp_ns: int,
    existence: FloatArray,
    counts: IntArray,
    flags: BoolArray,
    recent: BoolArray,
    missing_s: FloatArray,
    settings: Settings,
) -> None:
    """Take note of one frame, in place: `life_cycle.count_detections` and `Streaks.step`.

    Args:
        is_called: Shape (N,).
        is_seen: Shape (N,).
        stamp_ns: This frame's.
        existence: Shape (N,), after this frame.
        counts: Shape (6, N): streaks' detected and missed, detections, raised_since_ns, seen_ns,
            called_ns.
        flags: Shape (2, N): raised, confirmed.
        recent: Shape (N, W).
        missing_s: Shape (N,).
        settings: Of the tracker.
    """
    for person in range(len(existence)):
        for age in range(recent.shape[1] - 1, 0, -1):
            recent[person, age] = recent[person, age - 1]
        recent[person, 0] = is_called[person]
        was_raised = flags[0, person]
        if is_called[person]:
            counts[0, person] += 1
            counts[1, person] = 0
            counts[2, person] += 1
            counts[5, person] = stamp_ns
            flags[0, person] |= counts[0, person] >= settings.raise_streak
        else:
            counts[0, person] = 0
            counts[1, person] += 1
            flags[0, person] &= counts[1, person] < settings.lower_streak
        if flags[0, person] and not was_raised:
            counts[3, person] = stamp_ns
        if is_seen[person]:
            counts[4, person] = stamp_ns
            missing_s[person] = 0.0
        if settings.confirms_by_existence > 0.0:
            is_convinced = is_called[person] and existence[person] >= settings.confirm_existence
        else:
            is_convinced = recent[person].sum() >= settings.confirm_detections
        flags[1, person] |= is_convinced


@njit(error_model="numpy")
def decide_who_stays(
    is_customer: BoolArray,
    stamp_ns: int,
    born_ns: IntArray,
    existence: FloatArray,
    counts: IntArray,
    flags: BoolArray,
    recent: BoolArray,
    missing_s: FloatArray,
    settings: Settings,
    keep: BoolArray,
) -> None:
    """Whom to keep, written to `keep`; the arguments are as above: `life_cycle.still_there`."""
    for person in range(len(existence)):
        if not is_customer[person]:
            known_s = (counts[4, person] - born_ns[person]) / 1e9
            keep[person] = missing_s[person] <= min(known_s, settings.delete_after_s) + 1e-9
            continue
        patience_s = settings.delete_after_s * min(
            counts[2, person] / settings.mature_detections, 1.0
        )
        is_alive = missing_s[person] <= patience_s + 1e-9 and counts[
            5, person
        ] >= stamp_ns - round(settings.forget_after_s * 1e9)
        if not flags[1, person]:
            if settings.confirms_by_existence > 0.0:
                is_alive &= existence[person] >= EXISTENCE_MIN
            else:
                is_alive = _may_be_confirmed(recent[person], settings.confirm_detections)
        keep[person] = is_alive


@njit(error_model="numpy")
def _may_be_confirmed(recent: BoolArray, needed: float) -> bool:
    window = len(recent)
    for fresh in range(1, window):
        kept = recent[: window - fresh].sum()
        if kept >= 1 and kept + fresh >= needed:
            return True
    return False


@njit(error_model="numpy")
def has_twins(
    mean: FloatArray, is_customer: BoolArray, is_seen: BoolArray, distance_m: float
) -> bool:
    """Whether a silent customer stands that close to somebody seen: then `merge_twins` decides."""
    for silent in range(len(mean)):
        if is_seen[silent] or not is_customer[silent]:
            continue
        for seen in range(len(mean)):
            dx, dy = mean[silent, 0] - mean[seen, 0], mean[silent, 1] - mean[seen, 1]
            if is_seen[seen] and dx * dx + dy * dy < distance_m**2:
                return True
    return False
