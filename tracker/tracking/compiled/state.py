"""What is known of everybody, laid out for loops: few arrays, one for each type of number."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray
from tracker.tracking.appearance import Appearance
from tracker.tracking.compiled.loop import loop
from tracker.tracking.modes import Belief
from tracker.tracking.people import People
from tracker.tracking.streaks import Streaks

#: Rows of `spans`, `counts` and `flags`; the names are those of `People` and `Streaks`.
EXISTENCE, MISSING_S = range(2)
ID, BORN_NS, DETECTED, MISSED, DETECTIONS, RAISED_SINCE_NS, SEEN_NS, CALLED_NS, HAND = range(9)
RAISED, CONFIRMED = range(2)


class State(NamedTuple):
    """N people in K modes of motion, all but the clothes.

    Attributes:
        weight: Shape (K, N).
        mean: Shape (K, N, 4).
        covariance: Shape (K, N, 4, 4).
        spans: Shape (2, N).
        counts: Shape (9, N).
        flags: Shape (2, N).
        recent: Shape (N, W).
    """

    weight: FloatArray
    mean: FloatArray
    covariance: FloatArray
    spans: FloatArray
    counts: IntArray
    flags: BoolArray
    recent: BoolArray


def state_of(people: People) -> State:
    """People as loops want them."""
    streaks, belief = people.streaks, people.belief
    streak = (streaks.detected, streaks.missed, people.detections)
    stamps_ns = (people.raised_since_ns, people.seen_ns, people.called_ns)
    return State(
        np.ascontiguousarray(belief.weight),
        np.ascontiguousarray(belief.mean),
        np.ascontiguousarray(belief.covariance),
        np.array((people.existence, people.missing_s)),
        np.array((people.id, people.born_ns, *streak, *stamps_ns, people.hand)),
        np.array((streaks.raised, people.confirmed)),
        np.ascontiguousarray(people.recent),
    )


def people_of(state: State, mean: FloatArray, covariance: FloatArray) -> People:
    """The way back; the clothes are unknown.

    Args:
        state: Of N people.
        mean: Shape (N, 4): over the modes.
        covariance: Shape (N, 4, 4).
    """
    for array in (*state, mean, covariance):
        array.setflags(write=False)  # once for all that looks into them
    existence, missing_s = state.spans
    id, born_ns, detected, missed, detections, raised_since_ns, seen_ns, called_ns, hand = (
        state.counts
    )
    raised, confirmed = state.flags
    return People(
        id=id,
        belief=Belief(state.weight, state.mean, state.covariance, (mean, covariance)),
        existence=existence,
        confirmed=confirmed,
        recent=state.recent,
        detections=detections,
        streaks=Streaks(detected, missed, raised),
        raised_since_ns=raised_since_ns,
        born_ns=born_ns,
        seen_ns=seen_ns,
        called_ns=called_ns,
        missing_s=missing_s,
        hand=hand,
        appearance=Appearance.unknown(len(id)),
    )


@loop
def empty(modes: int, people: int, window: int) -> State:
    """Room for so many, with anything in it."""
    return State(
        np.empty((modes, people)),
        np.empty((modes, people, 4)),
        np.empty((modes, people, 4, 4)),
        np.empty((2, people)),
        np.empty((9, people), np.int64),
        np.empty((2, people), np.bool_),
        np.empty((people, window), np.bool_),
    )


@loop
def copy_person(source: State, row: int, target: State, to: int) -> None:
    """Write everything about somebody into another row; slices would compile slowly."""
    for mode in range(len(source.weight)):
        target.weight[mode, to] = source.weight[mode, row]
        for i in range(4):
            target.mean[mode, to, i] = source.mean[mode, row, i]
            for j in range(4):
                target.covariance[mode, to, i, j] = source.covariance[mode, row, i, j]
    for item in range(len(source.spans)):
        target.spans[item, to] = source.spans[item, row]
    for item in range(len(source.counts)):
        target.counts[item, to] = source.counts[item, row]
    for item in range(len(source.flags)):
        target.flags[item, to] = source.flags[item, row]
    for age in range(source.recent.shape[1]):
        target.recent[to, age] = source.recent[row, age]


@loop
def selected(state: State, keep: BoolArray) -> State:
    """Those who are kept."""
    chosen = empty(len(state.weight), keep.sum(), state.recent.shape[1])
    to = 0
    for row in range(len(keep)):
        if keep[row]:
            copy_person(state, row, chosen, to)
            to += 1
    return chosen
