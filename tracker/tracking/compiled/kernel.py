"""The loops of one frame, from measurements and people to people: what numba compiles."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import types

from tracker.containers import BoolArray, FloatArray, IntArray
from tracker.containers.measurement_check import BEARING_VARIANCE_MAX
from tracker.tracking.compiled.admission import admit
from tracker.tracking.compiled.association import assign_pairs, marginals
from tracker.tracking.compiled.correction import update_assigned, update_jointly
from tracker.tracking.compiled.kept import kept
from tracker.tracking.compiled.life_cycle import (
    believe,
    count_detections,
    decide_who_stays,
    has_twins,
)
from tracker.tracking.compiled.loop import loop
from tracker.tracking.compiled.pairing import find_pairs
from tracker.tracking.compiled.prediction import merge_modes, predict, visibility
from tracker.tracking.compiled.renewal import renew
from tracker.tracking.compiled.settings import Settings, named
from tracker.tracking.compiled.state import State, selected
from tracker.tracking.observation import DETECTION_MIN, RAISES_AGAIN
from tracker.tracking.people import EXISTENCE, HAND, ID, MISSED, MISSING_S, RAISED


@loop
def _update(
    state: State,
    rows: IntArray,
    values: FloatArray,
    noise: FloatArray,
    model: IntArray,
    pose: FloatArray,
    doubt: FloatArray,
    visible: FloatArray,
    density: float,
    settings: Settings,
) -> IntArray:
    """Associate and correct, in place; gives the row of each track's measurement, or -1."""
    weight, mean, covariance = state.weight, state.mean, state.covariance
    tracks, claims = len(visible), len(rows)
    got = np.full(tracks, -1)
    if tracks == 0 or claims == 0:
        return got
    track, claim, numbers, odds = find_pairs(
        weight, mean, covariance, rows, values, noise, model, pose, doubt, density, settings
    )
    chance = np.empty(tracks)
    for person in range(tracks):
        chance[person] = max(visible[person] * settings.detection_probability, DETECTION_MIN)
    for pair in range(len(track)):
        odds[pair] += np.log(chance[track[pair]] / (1.0 - chance[track[pair]]))
    chosen = assign_pairs(track, claim, odds, tracks, claims)
    if settings.is_joint > 0.0:
        probability = marginals(track, claim, odds, tracks, claims)
        update_jointly(weight, mean, covariance, track, numbers, probability)
    else:
        update_assigned(weight, mean, covariance, chosen, numbers)
    believe(state.spans[EXISTENCE], chosen, odds, chance)
    for person in range(tracks):
        if chosen[person] >= 0:
            got[person] = rows[claim[chosen[person]]]
    return got


@loop
def _left(rows: IntArray, taken: IntArray, claims: int) -> IntArray:
    """Rows that are nobody's."""
    is_taken = np.zeros(claims, np.bool_)
    for row in taken:
        if row >= 0:
            is_taken[row] = True
    left, count = np.empty(len(rows), np.int64), 0
    for row in rows:
        if not is_taken[row]:
            left[count] = row
            count += 1
    return left[:count]


def _given(kind: types.Type, dimensions: int) -> types.Array:
    return types.Array(kind, dimensions, "C", readonly=True)


_NUMBER, _WHOLE, _TRUTH = types.float64, types.int64, types.boolean
_STATE = (
    *(_given(_NUMBER, dimensions) for dimensions in (2, 3, 4, 2)),
    *(_given(_WHOLE, 2), _given(_TRUTH, 2), _given(_TRUTH, 2)),
)
#: Said beforehand, so that no array ever leads to another compilation by how it is laid out, and
#: that what comes out is read-only too.
_SIGNATURE = types.Tuple((*_STATE, _given(_NUMBER, 2), _given(_NUMBER, 3), _WHOLE))(
    *_STATE,
    *(_given(_NUMBER, 2), _given(_NUMBER, 3), _given(_WHOLE, 1), _given(_NUMBER, 2)),
    *(_given(_TRUTH, 1), _given(_WHOLE, 1), _given(_WHOLE, 1), _given(_NUMBER, 3)),
    _given(_TRUTH, 1),  # may_enter
    *(_given(_NUMBER, 3), _given(_NUMBER, 3), _given(_NUMBER, 2)),  # the motion
    *(_given(_NUMBER, 1), _given(_NUMBER, 1), _TRUTH),  # the views
    *(_WHOLE, _NUMBER, _WHOLE, _NUMBER, _given(_NUMBER, 1)),
)


@kept(_SIGNATURE)
def track_frame(
    weight: FloatArray,
    mean: FloatArray,
    covariance: FloatArray,
    spans: FloatArray,
    counts: IntArray,
    flags: BoolArray,
    recent: BoolArray,
    values: FloatArray,
    noise: FloatArray,
    model: IntArray,
    pose: FloatArray,
    raised: BoolArray,
    person: IntArray,
    hand: IntArray,
    doubt: FloatArray,
    may_enter: BoolArray,
    transition: FloatArray,
    motion_noise: FloatArray,
    switching: FloatArray,
    view: FloatArray,
    scan_view: FloatArray,
    has_scan: bool,
    next_id: int,
    dt_s: float,
    stamp_ns: int,
    bias: float,
    numbers: FloatArray,
) -> tuple[Any, ...]:
    """Everybody after one instant.

    Args:
        weight: Shape (K, N): of the last frame, as all of a `State`.
        mean: Shape (K, N, 4).
        covariance: Shape (K, N, 4, 4).
        spans: Shape (2, N).
        counts: Shape (9, N).
        flags: Shape (2, N).
        recent: Shape (N, W).
        values: Shape (M, 2): the arrays of `Measurements`, up to `doubt`.
        noise: Shape (M, 2, 2).
        model: Shape (M,).
        pose: Shape (M, 3).
        raised: Shape (M,).
        person: Shape (M,).
        hand: Shape (M,).
        doubt: Shape (M, 3, 3).
        may_enter: Shape (M,): false where the doubt is no covariance.
        transition: Shape (K, 4, 4): the motion, as `Motion` has it.
        motion_noise: Shape (K, 4, 4).
        switching: Shape (K, K).
        view: Of the camera; see `prediction.visibility`.
        scan_view: Of the scan.
        has_scan: There is a scan.
        next_id: The next customer's identity.
        dt_s: Since the last frame.
        stamp_ns: Of this frame.
        bias: How many times wider a raised hand's bearing counts, where it is alone.
        numbers: As `settings_of` gives them.

    Returns:
        The arrays of a `State`, everybody's mean and covariance over the modes, shapes (N, 4) and
        (N, 4, 4), all of them read-only, and the identity of the next customer.
    """
    settings, tracks = named(numbers), weight.shape[1]
    state = State(
        np.empty_like(weight), np.empty_like(mean), np.empty_like(covariance),
        spans.copy(), counts.copy(), flags.copy(), recent.copy(),
    )  # fmt: skip
    predict(
        weight, mean, covariance, transition, motion_noise, switching,
        state.weight, state.mean, state.covariance,
    )  # fmt: skip
    one_mean, _ = merge_modes(state.weight, state.mean, state.covariance)
    rows, rest = admit(
        values, noise, model, pose, raised, person, may_enter, one_mean, state.flags[RAISED],
        settings.unknown_range_m, settings.same_person_distance_m,
    )  # fmt: skip
    in_camera = visibility(one_mean, view)
    in_view = in_camera
    if has_scan:
        in_view = np.maximum(in_camera, visibility(one_mean, scan_view))
    hand_chance = np.empty(tracks)
    for track in range(tracks):
        lapse_s = dt_s * in_view[track]
        state.spans[EXISTENCE, track] *= np.exp(-lapse_s / settings.delete_after_s)
        state.spans[MISSING_S, track] += lapse_s
        was_up = counts[MISSED, track] == 0
        hand_chance[track] = in_camera[track] * (1.0 if was_up else RAISES_AGAIN)

    biased = noise.copy()
    if bias > 1.0:
        for row in rows:
            if np.isnan(values[row, 1]):
                biased[row, 0, 0] = min(noise[row, 0, 0] * bias, BEARING_VARIANCE_MAX)
    called_by = _update(
        state, rows, values, biased, model, pose, doubt,
        hand_chance, settings.newcomer_density, settings,
    )  # fmt: skip
    shown_by = _update(
        state, rest, values, biased, model, pose, doubt,
        in_view, settings.bystander_density, settings,
    )  # fmt: skip

    is_called, is_seen = called_by >= 0, (called_by >= 0) | (shown_by >= 0)
    for track in range(tracks):
        if is_called[track]:
            state.counts[HAND, track] = hand[called_by[track]]
            if counts[ID, track] == 0:  # bystanders who raise a hand become customers
                state.counts[ID, track] = next_id
                next_id += 1
        elif is_seen[track]:
            state.counts[HAND, track] = hand[shown_by[track]]
        else:
            state.counts[HAND, track] = -1
    count_detections(state, 0, is_called, is_seen, stamp_ns, settings)
    one_mean, one_covariance = merge_modes(state.weight, state.mean, state.covariance)
    rows, rest = _left(rows, called_by, len(values)), _left(rest, shown_by, len(values))
    distance_m = settings.same_person_distance_m
    is_same = False
    if len(rows) or len(rest) or has_twins(one_mean, state.counts[ID], is_seen, distance_m):
        state, next_id = renew(
            state, one_mean, is_called, is_seen, rows, rest,
            values, biased, model, pose, doubt, hand, stamp_ns, next_id, settings,
        )  # fmt: skip
    else:
        stays = decide_who_stays(state, tracks, stamp_ns, settings)
        is_same = bool(stays.all())
        state = selected(state, stays)
    if not is_same:
        one_mean, one_covariance = merge_modes(state.weight, state.mean, state.covariance)
    return (
        state.weight, state.mean, state.covariance, state.spans, state.counts, state.flags,
        state.recent, one_mean, one_covariance, next_id,
    )  # fmt: skip
