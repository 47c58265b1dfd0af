"""Which measurement belongs to which track, and how probably?

Every hypothesis has its likelihood, also that a track was missed and that a measurement comes from
nobody known; so all of them compare. Three ways to decide:

    pda        the most likely one-to-one assignment says whose a measurement is; the update counts
               with the probability of that pair, odds / (1 + odds)
    hungarian  the same assignment; what is assigned is certain
    jpda       every pair inside the gate counts, with its probability over all hypotheses
"""

from __future__ import annotations

import numpy as np

from tracker.compiling.loops import loop, maker
from tracker.containers import FloatArray, IntArray
from tracker.tracking.association.gating import Pairs
from tracker.tracking.settings import Settings

#: Sweeps of belief propagation end once no message changes by more, or after so many: then the
#: answer is still a probability, only not the best one.
CHANGE_MIN = 1e-9
SWEEPS_MAX = 200
#: Beyond, a pair is certain; sums over the other pairs would drown in rounding errors.
LOG_ODDS_MAX = 20.0


@maker
def associate(
    pairs: Pairs, tracks: int, claims: int, settings: Settings
) -> tuple[IntArray, FloatArray]:
    """The pair of each track, and how much each pair counts.

    Args:
        pairs: P pairs, by track.
        tracks: N.
        claims: M; pairs name claims below that.
        settings: Of the tracker.

    Returns:
        Row of each track's pair, or -1, shape (N,); the probability of each pair, shape (P,).
    """
    chosen = assign(pairs, tracks, claims)
    if settings.is_joint > 0.0:
        return chosen, marginals(pairs, tracks, claims)
    probability = np.empty(len(pairs.track))
    for pair in range(len(pairs.track)):
        probability[pair] = 0.0
    for person in range(tracks):
        pair = chosen[person]
        if pair >= 0:
            probability[pair] = 1.0
            if settings.is_hard == 0.0:
                probability[pair] = 1.0 / (1.0 + np.exp(-pairs.log_odds[pair]))
    return chosen, probability


@maker
def assign(pairs: Pairs, tracks: int, claims: int) -> IntArray:
    """Row of each track's pair, or -1: one to one, at the highest sum of log-odds.

    A pair at 0 or below is not worth taking. Where everybody's best is nobody else's nothing can
    be better; otherwise the Hungarian algorithm decides.

    Args:
        pairs: P pairs, by track.
        tracks: N.
        claims: M.
    """
    chosen = np.empty(tracks, np.int64)
    for person in range(tracks):
        chosen[person] = -1
    for pair in range(len(pairs.track)):
        best = chosen[pairs.track[pair]]
        odds = pairs.log_odds[pair]
        if odds > 0.0 and (best < 0 or odds > pairs.log_odds[best]):
            chosen[pairs.track[pair]] = pair
    taken = np.empty(claims, np.bool_)
    for row in range(claims):
        taken[row] = False
    for person in range(tracks):
        if chosen[person] >= 0:
            if taken[pairs.claim[chosen[person]]]:
                return _assign_disputed(pairs, tracks, claims)
            taken[pairs.claim[chosen[person]]] = True
    return chosen


@maker
def _assign_disputed(pairs: Pairs, tracks: int, claims: int) -> IntArray:
    """The Hungarian algorithm, by shortest augmenting paths along the pairs.

    One track after the other takes the measurement that costs least, over paths in which tracks
    hand theirs on; at the end of a path stands a free measurement, or a track that goes without.

    Source: Jonker and Volgenant, "A shortest augmenting path algorithm for dense and sparse linear
        assignment problems", Computing 38, 1987.
    """
    first = np.empty(tracks + 1, np.int64)  # of each track's pairs
    pair = 0
    for person in range(tracks + 1):
        while pair < len(pairs.track) and pairs.track[pair] < person:
            pair += 1
        first[person] = pair
    pair_of, price_of = np.empty(tracks, np.int64), np.empty(tracks)
    owner, price = np.empty(claims, np.int64), np.empty(claims)
    for person in range(tracks):
        pair_of[person], price_of[person] = -1, 0.0
    for row in range(claims):
        owner[row], price[row] = -1, 0.0
    shortest, via = np.empty(claims), np.empty(claims, np.int64)
    is_done = np.empty(claims, np.bool_)
    for newcomer in range(tracks):
        _augment(newcomer, pairs, first, pair_of, price_of, owner, price, shortest, via, is_done)
    return pair_of


@loop
def _augment(
    newcomer: int,
    pairs: Pairs,
    first: IntArray,
    pair_of: IntArray,
    price_of: FloatArray,
    owner: IntArray,
    price: FloatArray,
    shortest: FloatArray,
    via: IntArray,
    is_done: np.ndarray,
) -> None:
    """Assign one more track; the track for which it is cheapest stays without a measurement."""
    for row in range(len(owner)):
        shortest[row], via[row], is_done[row] = np.inf, -1, False
    person, length = newcomer, 0.0
    without, least_without = -1, np.inf
    while True:
        missed = length - price_of[person]
        if missed < least_without:
            without, least_without = person, missed
        for pair in range(first[person], first[person + 1]):
            row = pairs.claim[pair]
            if pairs.log_odds[pair] > 0.0 and not is_done[row]:
                reach = length - pairs.log_odds[pair] - price_of[person] - price[row]
                if reach < shortest[row]:
                    shortest[row], via[row] = reach, pair
        nearest, length = -1, least_without
        for row in range(len(owner)):
            if not is_done[row] and shortest[row] < length:
                nearest, length = row, shortest[row]
        if nearest < 0 or owner[nearest] < 0:
            break
        is_done[nearest] = True
        person = owner[nearest]
    price_of[newcomer] += length
    for row in range(len(owner)):
        if is_done[row]:
            price_of[owner[row]] += length - shortest[row]
            price[row] -= length - shortest[row]
    if nearest < 0:  # somebody goes without; those before hand theirs on
        pair, pair_of[without] = pair_of[without], -1
        if without == newcomer:
            return
        nearest = pairs.claim[pair]
    while nearest >= 0:
        pair = via[nearest]
        person = pairs.track[pair]
        owner[nearest] = person
        earlier, pair_of[person] = pair_of[person], pair
        nearest = pairs.claim[earlier] if earlier >= 0 and person != newcomer else -1


@maker
def marginals(pairs: Pairs, tracks: int, claims: int) -> FloatArray:
    """Probability of each pair over all one-to-one hypotheses, shape (P,).

    What they lack to 1 for a track is the probability that it was missed. Counting all hypotheses
    takes exponential time; loopy belief propagation on the same graph takes a few sweeps over the
    list of pairs, always converges, and is exact where the pairs form no loop.

    Source: Williams and Lau, "Approximate Evaluation of Marginal Association Probabilities with
        Belief Propagation", IEEE Transactions on Aerospace and Electronic Systems 50(4), 2014.
    """
    count, track, claim = len(pairs.track), pairs.track, pairs.claim
    weight, to_track, told = np.empty(count), np.empty(count), np.empty(count)
    of_track, of_claim, to_claim = np.empty(tracks), np.empty(claims), np.empty(count)
    for pair in range(count):
        weight[pair], to_track[pair] = np.exp(min(pairs.log_odds[pair], LOG_ODDS_MAX)), 1.0
    change, sweep = np.inf, 0
    while change >= CHANGE_MIN and sweep < SWEEPS_MAX:
        change, sweep = 0.0, sweep + 1
        _tell_claims(track, weight, to_track, told, of_track, to_claim)
        for row in range(claims):
            of_claim[row] = 0.0
        for pair in range(count):
            of_claim[claim[pair]] += to_claim[pair]
        for pair in range(count):
            message = 1.0 / (1.0 + max(of_claim[claim[pair]] - to_claim[pair], 0.0))
            change = max(change, abs(message - to_track[pair]))
            to_track[pair] = message
    _tell_claims(track, weight, to_track, told, of_track, to_claim)
    for pair in range(count):
        told[pair] /= 1.0 + of_track[track[pair]]
    return told


@loop
def _tell_claims(
    track: IntArray,
    weight: FloatArray,
    to_track: FloatArray,
    told: FloatArray,
    of_track: FloatArray,
    to_claim: FloatArray,
) -> None:
    """Half a sweep of belief propagation: messages from each track to each measurement."""
    for row in range(len(of_track)):
        of_track[row] = 0.0
    for pair in range(len(track)):
        told[pair] = weight[pair] * to_track[pair]
        of_track[track[pair]] += told[pair]
    for pair in range(len(track)):
        others = max(of_track[track[pair]] - told[pair], 0.0)
        to_claim[pair] = weight[pair] / (1.0 + others)
