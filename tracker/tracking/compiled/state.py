"""What is known of everybody, as loops take it: the arrays of `People`."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray
from tracker.containers.arrays import trusted
from tracker.tracking.compiled.loop import loop
from tracker.tracking.modes import Belief
from tracker.tracking.people import People


class State(NamedTuple):
    """N people in K modes of motion; the rows of the tables are named beside `People`.

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
    flat, belief = np.ascontiguousarray, people.belief
    return State(
        flat(belief.weight),
        flat(belief.mean),
        flat(belief.covariance),
        flat(people.spans),
        flat(people.counts),
        flat(people.flags),
        flat(people.recent),
    )


def people_of(state: State, mean: FloatArray, covariance: FloatArray) -> People:
    """The way back.

    Args:
        state: Of N people, all read-only.
        mean: Shape (N, 4): over the modes.
        covariance: Shape (N, 4, 4).
    """
    return trusted(
        People,
        belief=Belief(state.weight, state.mean, state.covariance, (mean, covariance)),
        spans=state.spans,
        counts=state.counts,
        flags=state.flags,
        recent=state.recent,
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
def with_room(state: State, more: int) -> State:
    """The same people, with room for so many more; nothing is copied for nobody."""
    if more == 0:
        return state
    modes, people = state.weight.shape
    room = empty(modes, people + more, state.recent.shape[1])
    for mode in range(modes):
        for row in range(people):
            room.weight[mode, row] = state.weight[mode, row]
            for i in range(4):
                room.mean[mode, row, i] = state.mean[mode, row, i]
                for j in range(4):
                    room.covariance[mode, row, i, j] = state.covariance[mode, row, i, j]
    _copy_all(state.spans, room.spans)
    _copy_all(state.counts, room.counts)
    _copy_all(state.flags, room.flags)
    _copy_all(state.recent, room.recent)
    return room


@loop
def _copy_all(source: np.ndarray, target: np.ndarray) -> None:
    """Write a table into the upper left of another one."""
    rows, columns = source.shape
    for row in range(rows):
        for column in range(columns):
            at = np.uint64(row), np.uint64(column)  # nothing is counted from the end
            target[at] = source[at]


@loop
def selected(state: State, keep: BoolArray) -> State:
    """Those who are kept; nothing is copied if that is all."""
    if keep.all():
        return state
    chosen = empty(len(state.weight), keep.sum(), state.recent.shape[1])
    to = 0
    for row in range(len(keep)):
        if keep[row]:
            copy_person(state, row, chosen, to)
            to += 1
    return chosen
