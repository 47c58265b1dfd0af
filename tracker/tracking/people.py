"""What does the tracker remember of everybody between two frames?"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.compiling.loops import loop, maker
from tracker.containers import BoolArray, FloatArray, IntArray

#: Rows of `People.spans`: probability that somebody is there; time in which nothing showed them
#: although they were in view; time since the first and since the last measurement; covariance in
#: square meters of what lasts of the place's error (see `bias`).
EXISTENCE, MISSING_S, AGE_S, UNSEEN_S, BIAS_XX, BIAS_XY, BIAS_YY = range(7)
#: Rows of `People.counts`. ID is above 0 for customers and below for bystanders, whose hand has
#: never been up; then stamps of the first and the last measurement, of the last raised hand and
#: of when the hand last began to count as raised (-1 never); the streaks' counters; raised-hand
#: detections in all; row of this frame's `Hands`, or -1; the last hint of identity, or -1.
ID, BORN_NS, SEEN_NS, CALLED_NS, RAISED_SINCE_NS, DETECTED, MISSED, DETECTIONS, HAND, TAG = range(
    10
)
#: Rows of `People.flags`: the streak's word, and whether a customer is believed.
RAISED, CONFIRMED = range(2)


class People(NamedTuple):
    """N people in K modes of motion: few arrays, one for each type of number.

    Attributes:
        weight: Shape (K, N): probability of each mode, adding up to 1.
        mean: Shape (K, N, 4): x_m, y_m, vx_mps, vy_mps in the fixed frame.
        covariance: Shape (K, N, 4, 4).
        spans: Shape (7, N); its rows, and those of the next two, are named above.
        counts: Shape (10, N), int64.
        flags: Shape (2, N), bool.
        recent: Shape (N, W), bool: raised-hand detections of the last W images, newest first.
    """

    weight: FloatArray
    mean: FloatArray
    covariance: FloatArray
    spans: FloatArray
    counts: IntArray
    flags: BoolArray
    recent: BoolArray


@maker
def room_for(modes: int, people: int, window: int) -> People:
    """Room for so many, with anything in it."""
    return People(
        np.empty((modes, people)),
        np.empty((modes, people, 4)),
        np.empty((modes, people, 4, 4)),
        np.empty((7, people)),
        np.empty((10, people), np.int64),
        np.empty((2, people), np.bool_),
        np.empty((people, window), np.bool_),
    )


@loop
def copy_person(source: People, row: int, target: People, to: int) -> None:
    """Write everything about somebody into another row."""
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


@maker
def with_room(people: People, more: int) -> People:
    """The same people, with room for so many more behind them."""
    count = people.weight.shape[1]
    room = room_for(len(people.weight), count + more, people.recent.shape[1])
    for row in range(count):
        copy_person(people, row, room, row)
    return room


@maker
def kept(people: People, keep: BoolArray, count: int) -> People:
    """Those who are kept, `count` of them, in order."""
    chosen = room_for(len(people.weight), count, people.recent.shape[1])
    to = 0
    for row in range(len(keep)):
        if keep[row]:
            copy_person(people, row, chosen, to)
            to += 1
    return chosen
