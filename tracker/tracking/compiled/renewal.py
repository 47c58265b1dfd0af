"""Who is new, who is tracked twice, who is gone? `renewal` and `twins` as loops."""

from __future__ import annotations

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray, SensorKind
from tracker.tracking.compiled.life_cycle import count_detections, decide_who_stays
from tracker.tracking.compiled.loop import loop
from tracker.tracking.compiled.pairing import pose_doubt
from tracker.tracking.compiled.settings import Settings
from tracker.tracking.compiled.state import State, copy_person, selected, with_room
from tracker.tracking.life_cycle import BIRTH_EXISTENCE
from tracker.tracking.people import (
    BORN_NS,
    CALLED_NS,
    CONFIRMED,
    DETECTIONS,
    EXISTENCE,
    HAND,
    ID,
    MISSING_S,
    RAISED,
    RAISED_SINCE_NS,
    SEEN_NS,
)
from tracker.tracking.sensor_model import RANGE_FLOOR_M
from tracker.tracking.twins import SILENT_S, TOGETHER_S

_CARTESIAN = int(SensorKind.POSITION)


@loop
def renew(
    state: State,
    place: FloatArray,
    is_called: BoolArray,
    is_seen: BoolArray,
    raised: IntArray,
    others: IntArray,
    values: FloatArray,
    noise: FloatArray,
    model: IntArray,
    pose: FloatArray,
    doubt: FloatArray,
    hand: IntArray,
    stamp_ns: int,
    next_id: int,
    settings: Settings,
) -> tuple[State, int]:
    """Let people in, bring twins together, let those go who are not there any more.

    Args:
        state: N people after this instant; may be changed.
        place: Shape (N, 4): their means over the modes.
        is_called: Shape (N,): a raised hand was theirs.
        is_seen: Shape (N,): any measurement was theirs.
        raised: Rows of the raised hands that are nobody's.
        others: Rows of the other measurements that are nobody's.
        values: Shape (M, 2): the arrays of `Measurements`, up to `hand`.
        noise: Shape (M, 2, 2).
        model: Shape (M,).
        pose: Shape (M, 3).
        doubt: Shape (M, 3, 3).
        hand: Shape (M,).
        stamp_ns: This frame's.
        next_id: The next customer's identity.
        settings: Of the tracker.

    Returns:
        Everybody from now on, and the identity of the next customer after them.
    """
    known = state.weight.shape[1]
    room = with_room(state, len(others) + len(raised))
    people = known
    for claim in others:  # a lowered hand alone is nobody
        if hand[claim] < 0:
            _begin(room, people, claim, values, noise, model, pose, doubt, stamp_ns, settings)
            people += _is_apart(room, people, place, is_seen, settings)
    was_seen = np.ones(people, np.bool_)
    was_seen[:known] = is_seen
    keep = np.zeros(len(room.recent), np.bool_)
    keep[:people] = True
    _merge_twins(room, place, was_seen, keep, settings)
    newcomers = people
    for claim in raised:
        _begin(room, people, claim, values, noise, model, pose, doubt, stamp_ns, settings)
        if _is_apart(room, people, place, is_called, settings):
            room.counts[ID, people], room.counts[HAND, people] = next_id, hand[claim]
            next_id, people = next_id + 1, people + 1
    called = np.ones(people, np.bool_)
    count_detections(room, newcomers, called, called, stamp_ns, settings)
    stays = decide_who_stays(room, people, stamp_ns, settings)
    for row in range(people):
        keep[row] = stays[row] and (keep[row] or row >= newcomers)
    return selected(room, keep), next_id


@loop
def _begin(
    room: State,
    row: int,
    claim: int,
    values: FloatArray,
    noise: FloatArray,
    model: IntArray,
    pose: FloatArray,
    doubt: FloatArray,
    stamp_ns: int,
    settings: Settings,
) -> None:
    """The person behind a claim: `filter.initial_state`, `Belief.begin` and `People.begin`."""
    first, second = values[claim]
    r00, r01, r11 = noise[claim, 0, 0], noise[claim, 0, 1], noise[claim, 1, 1]
    x, y = first, second
    h00, h01, h10, h11 = 1.0, 0.0, 0.0, 1.0  # derivative of the place by the measurement
    if model[claim] != _CARTESIAN:
        if np.isnan(second):
            second, r01, r11 = settings.unknown_range_m, 0.0, settings.unknown_range_std_m**2
        angle = first + pose[claim, 2]
        cos, sin = np.cos(angle), np.sin(angle)
        x, y = pose[claim, 0] + second * cos, pose[claim, 1] + second * sin
        range_m = max(second, RANGE_FLOOR_M)
        across, along = sin * second / range_m, cos * second / range_m
        d00, d01, d11 = pose_doubt(-across / range_m, along / range_m, along, across, doubt, claim)
        r00, r01, r11 = r00 + d00, r01 + d01, r11 + d11
        h00, h01, h10, h11 = -range_m * sin, cos, range_m * cos, sin
    a0, a1 = h00 * r00 + h01 * r01, h00 * r01 + h01 * r11
    b0, b1 = h10 * r00 + h11 * r01, h10 * r01 + h11 * r11
    modes = len(room.weight)
    for mode in range(modes):
        mean, covariance = room.mean[mode, row], room.covariance[mode, row]
        speed_std_mps = settings.initial_speed_std_mps
        if mode == 1:
            speed_std_mps = settings.stand_speed_std_mps
        for i in range(4):
            mean[i] = 0.0
            for j in range(4):
                covariance[i, j] = 0.0
        room.weight[mode, row], mean[0], mean[1] = 1.0 / modes, x, y
        covariance[0, 0], covariance[1, 1] = a0 * h00 + a1 * h01, b0 * h10 + b1 * h11
        covariance[0, 1] = covariance[1, 0] = a0 * h10 + a1 * h11
        covariance[2, 2] = covariance[3, 3] = speed_std_mps**2
    room.spans[EXISTENCE, row], room.spans[MISSING_S, row] = BIRTH_EXISTENCE, 0.0
    for item in range(len(room.counts)):
        room.counts[item, row] = 0
    room.counts[HAND, row] = room.counts[RAISED_SINCE_NS, row] = -1
    room.counts[BORN_NS, row] = room.counts[SEEN_NS, row] = stamp_ns
    room.counts[CALLED_NS, row] = stamp_ns
    room.flags[RAISED, row] = room.flags[CONFIRMED, row] = False
    for age in range(room.recent.shape[1]):
        room.recent[row, age] = False


@loop
def _is_apart(
    room: State, row: int, place: FloatArray, counts: BoolArray, settings: Settings
) -> bool:
    """Whether nobody of those who count stands where somebody new would."""
    x, y = room.mean[0, row, 0], room.mean[0, row, 1]
    for person in range(len(place)):
        dx, dy = x - place[person, 0], y - place[person, 1]
        if counts[person] and dx * dx + dy * dy < settings.same_person_distance_m**2:
            return False
    return True


@loop
def _merge_twins(
    room: State, place: FloatArray, is_seen: BoolArray, keep: BoolArray, settings: Settings
) -> None:
    """Join silent customers with those seen beside them, in place: `twins.merge_twins`.

    Args:
        room: Everybody, those who have just come last.
        place: Shape (N, 4): the means of those who were there before.
        is_seen: Shape (P,): of all.
        keep: To be set to false for whoever is joined with somebody else.
        settings: Of the tracker.
    """
    counts, known = room.counts, len(place)
    for mute in range(known):
        if is_seen[mute] or counts[ID, mute] == 0:
            continue
        nearest, least, goes_on = -1, settings.same_person_distance_m, False
        for heard in range(len(is_seen)):
            if not is_seen[heard]:
                continue
            is_customer = counts[ID, heard] > 0
            together_s = (counts[SEEN_NS, mute] - counts[BORN_NS, heard]) / 1e9
            is_apart = is_other = together_s > TOGETHER_S
            if is_customer:
                is_apart = room.spans[MISSING_S, mute] <= SILENT_S
            at = place[heard] if heard < known else room.mean[0, heard]
            apart_m = np.hypot(place[mute, 0] - at[0], place[mute, 1] - at[1])
            if not is_apart and apart_m < least:
                nearest, least = heard, apart_m
                is_older = not is_customer or counts[ID, mute] < counts[ID, heard]
                goes_on = is_older and not is_other
        if nearest < 0:
            continue
        if goes_on and keep[nearest]:
            keep[nearest] = False
            _inherit(room, mute, nearest)
        else:
            keep[mute] = False


@loop
def _inherit(room: State, row: int, heir: int) -> None:
    """Somebody goes on in the heir's place; what a customer has been counts on."""
    counts = room.counts
    id, born_ns = counts[ID, row], counts[BORN_NS, row]
    detections, called_ns = counts[DETECTIONS, row], counts[CALLED_NS, row]
    was_confirmed = room.flags[CONFIRMED, row]
    copy_person(room, heir, room, row)
    counts[ID, row], counts[BORN_NS, row] = id, born_ns
    counts[DETECTIONS, row] = max(counts[DETECTIONS, row], detections)
    counts[CALLED_NS, row] = max(counts[CALLED_NS, row], called_ns)
    room.flags[CONFIRMED, row] |= was_confirmed
