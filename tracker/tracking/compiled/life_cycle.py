"""Who is a customer, who is gone, whose hand is up? `life_cycle` and `streaks` as loops."""

from __future__ import annotations

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray
from tracker.tracking.compiled.loop import loop
from tracker.tracking.compiled.settings import Settings
from tracker.tracking.compiled.state import State
from tracker.tracking.life_cycle import EXISTENCE_MIN, LOG_EVIDENCE_MAX
from tracker.tracking.people import (
    BORN_NS,
    CALLED_NS,
    CONFIRMED,
    DETECTED,
    DETECTIONS,
    EXISTENCE,
    ID,
    MISSED,
    MISSING_S,
    RAISED,
    RAISED_SINCE_NS,
    SEEN_NS,
)


@loop
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


@loop
def count_detections(
    state: State,
    first: int,
    is_called: BoolArray,
    is_seen: BoolArray,
    stamp_ns: int,
    settings: Settings,
) -> None:
    """Take note of one frame, in place: `life_cycle.count_detections` and `Streaks.step`.

    Args:
        state: Of everybody, with the existence after this frame.
        first: Whoever stands in an earlier row is passed over.
        is_called: Shape (N,).
        is_seen: Shape (N,).
        stamp_ns: This frame's.
        settings: Of the tracker.
    """
    counts, flags, recent = state.counts, state.flags, state.recent
    for person in range(first, len(is_called)):
        for age in range(recent.shape[1] - 1, 0, -1):
            recent[person, age] = recent[person, age - 1]
        recent[person, 0] = is_called[person]
        was_raised = flags[RAISED, person]
        if is_called[person]:
            counts[DETECTED, person] += 1
            counts[MISSED, person] = 0
            counts[DETECTIONS, person] += 1
            counts[CALLED_NS, person] = stamp_ns
            flags[RAISED, person] |= counts[DETECTED, person] >= settings.raise_streak
        else:
            counts[DETECTED, person] = 0
            counts[MISSED, person] += 1
            flags[RAISED, person] &= counts[MISSED, person] < settings.lower_streak
        if flags[RAISED, person] and not was_raised:
            counts[RAISED_SINCE_NS, person] = stamp_ns
        if is_seen[person]:
            counts[SEEN_NS, person] = stamp_ns
            state.spans[MISSING_S, person] = 0.0
        if settings.confirms_by_existence > 0.0:
            is_sure = state.spans[EXISTENCE, person] >= settings.confirm_existence
            is_convinced = is_called[person] and is_sure
        else:
            is_convinced = recent[person].sum() >= settings.confirm_detections
        flags[CONFIRMED, person] |= is_convinced


@loop
def decide_who_stays(state: State, people: int, stamp_ns: int, settings: Settings) -> BoolArray:
    """Whom of the first so many people to keep: `life_cycle.still_there`."""
    counts, keep = state.counts, np.empty(people, np.bool_)
    latest_ns = stamp_ns - round(settings.forget_after_s * 1e9)
    for person in range(people):
        missing_s = state.spans[MISSING_S, person]
        if counts[ID, person] == 0:
            known_s = (counts[SEEN_NS, person] - counts[BORN_NS, person]) / 1e9
            keep[person] = missing_s <= min(known_s, settings.delete_after_s) + 1e-9
            continue
        maturity = min(counts[DETECTIONS, person] / settings.mature_detections, 1.0)
        is_alive = missing_s <= settings.delete_after_s * maturity + 1e-9
        is_alive &= counts[CALLED_NS, person] >= latest_ns
        if not state.flags[CONFIRMED, person]:
            if settings.confirms_by_existence > 0.0:
                is_alive &= state.spans[EXISTENCE, person] >= EXISTENCE_MIN
            else:
                is_alive = _may_be_confirmed(state.recent[person], settings.confirm_detections)
        keep[person] = is_alive
    return keep


@loop
def _may_be_confirmed(recent: BoolArray, needed: float) -> bool:
    window = len(recent)
    for fresh in range(1, window):
        kept = recent[: window - fresh].sum()
        if kept >= 1 and kept + fresh >= needed:
            return True
    return False


@loop
def has_twins(mean: FloatArray, id: IntArray, is_seen: BoolArray, distance_m: float) -> bool:
    """Whether a silent customer stands that close to somebody seen."""
    for silent in range(len(mean)):
        if is_seen[silent] or id[silent] == 0:
            continue
        for seen in range(len(mean)):
            dx, dy = mean[silent, 0] - mean[seen, 0], mean[silent, 1] - mean[seen, 1]
            if is_seen[seen] and dx * dx + dy * dy < distance_m**2:
                return True
    return False
