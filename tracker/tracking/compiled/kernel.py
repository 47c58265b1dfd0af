"""The loops of one frame, from measurements and people to people: what numba compiles."""

from __future__ import annotations

import numpy as np
from numba import njit, types

from tracker.containers import BoolArray, FloatArray, IntArray
from tracker.tracking.admission import BEARING_VARIANCE_MAX
from tracker.tracking.compiled.admission import admit
from tracker.tracking.compiled.association import assign_pairs, marginals
from tracker.tracking.compiled.correction import update_assigned, update_jointly
from tracker.tracking.compiled.life_cycle import (
    believe,
    count_detections,
    decide_who_stays,
    has_twins,
)
from tracker.tracking.compiled.pairing import find_pairs
from tracker.tracking.compiled.prediction import merge_modes, predict, visibility
from tracker.tracking.compiled.settings import Settings, named
from tracker.tracking.compiled.sources import named_after_sources
from tracker.tracking.frame import DETECTION_MIN, RAISES_AGAIN


@njit(error_model="numpy")
def _update(
    weight: FloatArray,
    mean: FloatArray,
    covariance: FloatArray,
    existence: FloatArray,
    rows: IntArray,
    values: FloatArray,
    noise: FloatArray,
    model: IntArray,
    pose: FloatArray,
    doubt: FloatArray,
    visible: FloatArray,
    settings: Settings,
) -> IntArray:
    """Associate and correct, in place; gives the row of each track's measurement, or -1."""
    tracks, claims = len(existence), len(rows)
    got = np.full(tracks, -1)
    if tracks == 0 or claims == 0:
        return got
    track, claim, numbers, odds = find_pairs(
        weight, mean, covariance, rows, values, noise, model, pose, doubt, settings
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
    believe(existence, chosen, odds, chance)
    for person in range(tracks):
        if chosen[person] >= 0:
            got[person] = rows[claim[chosen[person]]]
    return got


def _given(kind: types.Type, dimensions: int) -> types.Array:
    return types.Array(kind, dimensions, "C", readonly=True)


_NUMBER, _WHOLE, _TRUTH = types.float64, types.int64, types.boolean
#: Said beforehand, so that no array ever leads to another compilation by how it is laid out.
_SIGNATURE = (
    *(_given(_NUMBER, dimensions) for dimensions in (2, 3, 4)),  # weight, mean, covariance
    *(_given(_WHOLE, 1), _given(_WHOLE, 1)),  # id, born_ns
    *(_given(_NUMBER, 2), _given(_NUMBER, 3), _given(_WHOLE, 1), _given(_NUMBER, 2)),
    *(_given(_TRUTH, 1), _given(_WHOLE, 1), _given(_WHOLE, 1), _given(_NUMBER, 3)),
    _given(_TRUTH, 1),  # may_enter
    *(_given(_NUMBER, 3), _given(_NUMBER, 3), _given(_NUMBER, 2)),  # the motion
    *(_given(_NUMBER, 1), _given(_NUMBER, 1), _TRUTH),  # the views
    *(_NUMBER, _WHOLE, _NUMBER, _given(_NUMBER, 1)),
    *(types.Array(_NUMBER, dimensions, "C") for dimensions in (2, 3, 4)),  # what comes out
    *(types.Array(_NUMBER, 1, "C"), types.Array(_NUMBER, 1, "C")),
    *(types.Array(_WHOLE, 2, "C"), types.Array(_TRUTH, 2, "C"), types.Array(_TRUTH, 2, "C")),
    *(types.Array(_WHOLE, 1, "C"), types.Array(_TRUTH, 2, "C"), types.Array(_TRUTH, 1, "C")),
)


@njit(_SIGNATURE, cache=True, error_model="numpy")
@named_after_sources
def track_frame(
    weight: FloatArray,
    mean: FloatArray,
    covariance: FloatArray,
    id: IntArray,
    born_ns: IntArray,
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
    dt_s: float,
    stamp_ns: int,
    bias: float,
    numbers: FloatArray,
    weights: FloatArray,
    means: FloatArray,
    covariances: FloatArray,
    existence: FloatArray,
    missing_s: FloatArray,
    counts: IntArray,
    flags: BoolArray,
    recent: BoolArray,
    own_hand: IntArray,
    fate: BoolArray,
    is_left: BoolArray,
) -> bool:
    """Predict, associate, correct, count.

    Args:
        weight: Shape (K, N): of the last frame, as all up to `born_ns`.
        mean: Shape (K, N, 4).
        covariance: Shape (K, N, 4, 4).
        id: Shape (N,).
        born_ns: Shape (N,).
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
        dt_s: Since the last frame.
        stamp_ns: Of this frame.
        bias: How many times wider a raised hand's bearing counts, where it is alone.
        numbers: As `settings_of` gives them.
        weights: Shape (K, N), to be filled in, as the next two.
        means: Shape (K, N, 4).
        covariances: Shape (K, N, 4, 4).
        existence: Shape (N,): of the last frame, to be changed, as all up to `recent`.
        missing_s: Shape (N,).
        counts: Shape (6, N); see `life_cycle.count_detections`.
        flags: Shape (2, N); see there.
        recent: Shape (N, W).
        own_hand: Shape (N,), to be filled in.
        fate: Shape (3, N), to be filled in: called, seen, stays.
        is_left: Shape (M,), to be filled in: sane, and nobody's.

    Returns:
        Whether somebody may be tracked twice.
    """
    settings = named(numbers)
    rows, rest = admit(
        values, noise, model, pose, raised, person, may_enter,
        settings.unknown_range_m, settings.same_person_distance_m,
    )  # fmt: skip
    predict(
        weight, mean, covariance, transition, motion_noise, switching, weights, means, covariances
    )
    tracks = len(id)
    one_mean, _ = merge_modes(weights, means, covariances)
    in_camera = visibility(one_mean, view)
    in_view = in_camera
    if has_scan:
        in_view = np.maximum(in_camera, visibility(one_mean, scan_view))
    hand_chance = np.empty(tracks)
    for track in range(tracks):
        lapse_s = dt_s * in_view[track]
        existence[track] *= np.exp(-lapse_s / settings.delete_after_s)
        missing_s[track] += lapse_s
        hand_chance[track] = in_camera[track] * (1.0 if counts[1, track] == 0 else RAISES_AGAIN)

    biased = noise.copy()
    if bias > 1.0:
        for row in rows:
            if np.isnan(values[row, 1]):
                biased[row, 0, 0] = min(noise[row, 0, 0] * bias, BEARING_VARIANCE_MAX)
    called_by = _update(
        weights, means, covariances, existence, rows, values, biased, model, pose, doubt,
        hand_chance, settings,
    )  # fmt: skip
    shown_by = _update(
        weights, means, covariances, existence, rest, values, biased, model, pose, doubt,
        in_view, settings,
    )  # fmt: skip

    is_customer = np.empty(tracks, np.bool_)
    is_left[:] = False
    for row in rows:
        is_left[row] = True
    for row in rest:
        is_left[row] = True
    for track in range(tracks):
        is_customer[track] = id[track] > 0
        is_called, is_shown = called_by[track] >= 0, shown_by[track] >= 0
        fate[0, track], fate[1, track] = is_called, is_called or is_shown
        own_hand[track] = -1
        if is_shown:
            own_hand[track] = hand[shown_by[track]]
            is_left[shown_by[track]] = False
        if is_called:
            own_hand[track] = hand[called_by[track]]
            is_left[called_by[track]] = False
    count_detections(
        fate[0], fate[1], stamp_ns, existence, counts, flags, recent, missing_s, settings
    )
    decide_who_stays(
        is_customer, stamp_ns, born_ns, existence, counts, flags, recent, missing_s, settings,
        fate[2],
    )  # fmt: skip
    one_mean, _ = merge_modes(weights, means, covariances)
    return has_twins(one_mean, is_customer, fate[1], settings.same_person_distance_m)
