"""Which measurements are used in a frame, and in which round? Hands once per person, by sensor."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.compiling.loops import loop, maker, step
from tracker.containers import BoolArray, FloatArray, IntArray
from tracker.tracking.people import RAISED, People
from tracker.tracking.sensing.claims import Claims
from tracker.tracking.sensing.sensor_kinds import BEARING, BEARING_RANGE, KINDS, RANGE, begin
from tracker.tracking.settings import Settings

#: A hand that is up may be so far from where its owner is expected (guess).
CALLER_REACH_M = 0.7


class Rounds(NamedTuple):
    """Measurements in the order in which they count: round after round, raised hands first.

    A round is what one sensor says, and within it nobody has more than one measurement: what a
    sensor says of one body a second time has a round of its own.

    Attributes:
        rows: Shape (C,): of the claims.
        begins: Shape (R + 1,): of round i the rows begin at begins[i], and end at begins[i + 1].
        raised: How many rounds are raised hands.
    """

    rows: IntArray
    begins: IntArray
    raised: int


@maker
def plan_rounds(people: People, mean: FloatArray, claims: Claims, settings: Settings) -> Rounds:
    """Which measurements are used, and in which round.

    Args:
        people: N, predicted.
        mean: Shape (1, N, 4), over the modes.
        claims: M claims.
        settings: Of the tracker.
    """
    count = len(claims.kind)
    rows, begins = np.empty(count, np.int64), np.empty(count + 1, np.int64)
    is_left = np.empty(count, np.bool_)
    for row in range(count):
        is_left[row] = not claims.raised[row]
    for number in range(_hands_once(people, mean, claims, settings, rows)):
        is_left[rows[number]] = True
    filled = rounds = raised_rounds = 0
    begins[0] = 0
    for is_raised in (True, False):
        for leader in range(count):
            while is_left[leader] and claims.raised[leader] == is_raised:
                filled = _fill_round(claims, leader, is_left, rows, filled)
                rounds += 1
                begins[rounds] = filled
        if is_raised:
            raised_rounds = rounds
    return Rounds(rows[:filled], begins[: rounds + 1], raised_rounds)


@loop
def _fill_round(
    claims: Claims, leader: int, is_left: BoolArray, rows: IntArray, filled: int
) -> int:
    """Take all of a claim's sensor into its round, those of one kind side by side."""
    begin = filled
    for kind in range(KINDS):
        for row in range(leader, len(is_left)):
            is_mine = is_left[row] and claims.kind[row] == kind
            is_mine = is_mine and claims.raised[row] == claims.raised[leader]
            if is_mine and is_one_sensor(claims, row, leader):
                is_second = False
                for earlier in range(begin, filled):
                    body = claims.body[rows[earlier]]
                    is_second = is_second or (body >= 0 and body == claims.body[row])
                if not is_second:
                    rows[filled], is_left[row] = row, False
                    filled += 1
    return filled


@loop
def is_one_sensor(claims: Claims, row: int, other: int) -> bool:
    """Whether two claims were measured alike from the same place.

    A camera whose hands have a range now and then is one sensor.
    """
    kind, alike = claims.kind[row], claims.kind[other]
    kind = BEARING_RANGE if kind == BEARING else kind
    alike = BEARING_RANGE if alike == BEARING else alike
    if kind != alike:
        return False
    for i in range(3):
        if claims.pose[row, i] != claims.pose[other, i]:
            return False
        for j in range(3):
            if claims.doubt[row, i, j] != claims.doubt[other, i, j]:
                return False
    return True


@maker
def _hands_once(
    people: People, mean: FloatArray, claims: Claims, settings: Settings, kept: IntArray
) -> int:
    """Two raised hands of one person that one sensor shows count once: write the first rows down.

    Hands close together are one person's, unless somebody knows better, but as many of them count
    as customers call there. Whoever has been counted keeps out the rows after them, and only those
    who count do.
    """
    x_m, y_m, count = np.empty(len(kept)), np.empty(len(kept)), 0
    for row in range(len(kept)):
        if not claims.raised[row]:
            continue
        near = 0
        x, y, _, _, _ = begin(claims.kind[row], claims, row, settings)
        if claims.kind[row] == RANGE:  # a range alone says nothing of a place
            x = y = np.inf
        for earlier in range(count):
            other = kept[earlier]
            is_known = claims.body[row] >= 0 and claims.body[row] == claims.body[other]
            if is_known or not is_one_sensor(claims, row, other):
                continue
            across, along = x - x_m[earlier], y - y_m[earlier]
            near += across * across + along * along < settings.same_person_distance_m**2
        if near == 0 or near < _callers(x, y, people, mean):
            kept[count], x_m[count], y_m[count] = row, x, y
            count += 1
    return count


@step
def _callers(x: float, y: float, people: People, mean: FloatArray) -> int:
    """How many customers call at a place."""
    count = 0
    for person in range(people.flags.shape[1]):
        across, along = x - mean[0, person, 0], y - mean[0, person, 1]
        is_there = across * across + along * along < CALLER_REACH_M**2
        count += people.flags[RAISED, person] and is_there
    return count
