"""Which measurement belongs to which track? `association` and `joint_probability` as loops."""

from __future__ import annotations

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray
from tracker.tracking.compiled.loop import loop, step
from tracker.tracking.joint_probability import CHANGE_MIN, LOG_ODDS_MAX, SWEEPS_MAX


@loop
def assign_pairs(
    track: IntArray, claim: IntArray, odds: FloatArray, tracks: int, claims: int
) -> IntArray:
    """Row of each track's pair, or -1, at the highest sum of log-odds: `association.assign`.

    Where everybody's best is nobody else's nothing can be better. Otherwise each set of tracks and
    measurements that hang together through pairs is solved on its own.

    Args:
        track: Shape (P,): row of the track.
        claim: Shape (P,): row of the measurement.
        odds: Shape (P,): a pair at 0 or below is not worth taking.
        tracks: How many.
        claims: How many.
    """
    chosen = np.full(tracks, -1)
    for pair in range(len(track)):
        best = chosen[track[pair]]
        if odds[pair] > 0.0 and (best < 0 or odds[pair] > odds[best]):
            chosen[track[pair]] = pair
    if not _has_rivals(chosen, claim, claims):
        return chosen
    cluster = _clusters(track, claim, odds, tracks, claims)
    own_track, own_claim = np.full(tracks, -1), np.full(claims, -1)
    for name in range(tracks):
        if cluster[name] != name:
            continue
        rows = columns = 0
        for pair in range(len(track)):
            if odds[pair] > 0.0 and cluster[track[pair]] == name:
                if own_track[track[pair]] < 0:
                    own_track[track[pair]] = rows
                    rows += 1
                if own_claim[claim[pair]] < 0:
                    own_claim[claim[pair]] = columns
                    columns += 1
        if rows < 2:
            continue
        gain, pair_of = np.zeros((rows, columns)), np.full((rows, columns), -1)
        for pair in range(len(track)):
            if odds[pair] > 0.0 and cluster[track[pair]] == name:
                gain[own_track[track[pair]], own_claim[claim[pair]]] = odds[pair]
                pair_of[own_track[track[pair]], own_claim[claim[pair]]] = pair
        solved = assign_disputed(gain)
        for person in range(tracks):
            if cluster[person] == name and own_track[person] >= 0:
                column = solved[own_track[person]]
                chosen[person] = pair_of[own_track[person], column] if column >= 0 else -1
    return chosen


@loop
def _has_rivals(chosen: IntArray, claim: IntArray, claims: int) -> bool:
    is_taken = np.zeros(claims, np.bool_)
    for pair in chosen:
        if pair >= 0:
            if is_taken[claim[pair]]:
                return True
            is_taken[claim[pair]] = True
    return False


@loop
def _clusters(
    track: IntArray, claim: IntArray, odds: FloatArray, tracks: int, claims: int
) -> IntArray:
    """Each track's cluster, named after one of its tracks."""
    parent = np.arange(tracks)
    first_of = np.full(claims, -1)
    for pair in range(len(track)):
        if odds[pair] <= 0.0:
            continue
        if first_of[claim[pair]] < 0:
            first_of[claim[pair]] = track[pair]
            continue
        one, other = track[pair], first_of[claim[pair]]
        while parent[one] != one:
            one = parent[one]
        while parent[other] != other:
            other = parent[other]
        parent[max(one, other)] = min(one, other)
    for person in range(tracks):  # a parent stands before its children
        parent[person] = parent[parent[person]]
    return parent


@step
def assign(gain: FloatArray, row_of: IntArray, is_taken: BoolArray) -> None:
    """Row of the measurement of each person, or -1: at the highest sum of gains."""
    row_of[:], is_taken[:] = -1, False
    for person in range(len(gain)):
        best, most = -1, 0.0
        for row in range(len(is_taken)):
            if gain[person, row] > most:
                best, most = row, gain[person, row]
        if best >= 0:
            if is_taken[best]:
                row_of[:] = assign_disputed(gain)
                return
            is_taken[best] = True
            row_of[person] = best


@loop
def marginals(
    track: IntArray, claim: IntArray, odds: FloatArray, tracks: int, claims: int
) -> FloatArray:
    """Probability of each pair by loopy belief propagation: `joint_probability.marginals`."""
    pairs = len(track)
    weight, to_track, told = np.empty(pairs), np.ones(pairs), np.empty(pairs)
    of_track, of_claim, to_claim = np.empty(tracks), np.empty(claims), np.empty(pairs)
    for pair in range(pairs):
        weight[pair] = np.exp(min(odds[pair], LOG_ODDS_MAX))
    for _ in range(SWEEPS_MAX):
        of_track[:] = 0.0
        for pair in range(pairs):
            told[pair] = weight[pair] * to_track[pair]
            of_track[track[pair]] += told[pair]
        of_claim[:] = 0.0
        for pair in range(pairs):
            others = max(of_track[track[pair]] - told[pair], 0.0)
            to_claim[pair] = weight[pair] / (1.0 + others)
            of_claim[claim[pair]] += to_claim[pair]
        change = 0.0
        for pair in range(pairs):
            others = max(of_claim[claim[pair]] - to_claim[pair], 0.0)
            message = 1.0 / (1.0 + others)
            change = max(change, abs(message - to_track[pair]))
            to_track[pair] = message
        if change < CHANGE_MIN:
            break
    of_track[:] = 0.0
    for pair in range(pairs):
        told[pair] = weight[pair] * to_track[pair]
        of_track[track[pair]] += told[pair]
    for pair in range(pairs):
        told[pair] /= 1.0 + of_track[track[pair]]
    return told


@loop
def assign_disputed(gain: FloatArray) -> IntArray:
    """The Hungarian algorithm, by shortest augmenting paths.

    Each person has a column of their own for "missed" beside those of the measurements, so that
    there is a column for everybody.

    Source: Jonker and Volgenant, "A shortest augmenting path algorithm for dense and sparse linear
        assignment problems", Computing 38, 1987.
    """
    people, measured = gain.shape
    columns = measured + people
    price_of_person, price = np.zeros(people), np.zeros(columns)
    owner = np.full(columns, -1)
    for newcomer in range(people):
        shortest, before = np.full(columns, np.inf), np.full(columns, -1)
        is_done = np.zeros(columns, np.bool_)
        person, last, length = newcomer, -1, 0.0
        while person >= 0:
            nearest, least = -1, np.inf
            for column in range(columns):
                if is_done[column]:
                    continue
                cost = -gain[person, column] if column < measured else 0.0
                reach = length + cost - price_of_person[person] - price[column]
                if reach < shortest[column]:
                    shortest[column], before[column] = reach, last
                if shortest[column] < least:
                    nearest, least = column, shortest[column]
            is_done[nearest] = True
            length, last, person = least, nearest, owner[nearest]
        price_of_person[newcomer] += length
        for column in range(columns):
            if is_done[column] and column != last:
                price_of_person[owner[column]] += length - shortest[column]
                price[column] -= length - shortest[column]
        while last >= 0:
            earlier = before[last]
            owner[last] = newcomer if earlier < 0 else owner[earlier]
            last = earlier
    chosen = np.full(people, -1)
    for column in range(measured):
        person = owner[column]
        if person >= 0 and gain[person, column] > 0.0:
            chosen[person] = column
    return chosen
