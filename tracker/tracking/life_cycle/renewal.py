"""Who is new, who is tracked twice, who is gone?"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.compiling.loops import loop, maker
from tracker.containers import FloatArray
from tracker.tracking import people as field
from tracker.tracking.association.found import NOBODY, Found
from tracker.tracking.instant import Instant
from tracker.tracking.life_cycle.duplicates import merge_duplicates
from tracker.tracking.life_cycle.life_cycle import count_person, is_still_there
from tracker.tracking.life_cycle.newcomers import let_in
from tracker.tracking.people import People, kept, with_room
from tracker.tracking.prediction.modes import merge_modes
from tracker.tracking.sensing.claims import Claims
from tracker.tracking.settings import Settings


class Frame(NamedTuple):
    """Everybody after one instant.

    Attributes:
        people: N people.
        mean: Shape (1, N, 4), over the modes of motion.
        covariance: Shape (1, N, 4, 4).
        next_id: Of the next customer.
        next_bystander: Of the next bystander, below 0.
        refused: Measurements that are nobody's and cannot show anybody new.
    """

    people: People
    mean: FloatArray
    covariance: FloatArray
    next_id: int
    next_bystander: int
    refused: int


@maker
def renew(
    people: People, claims: Claims, found: Found, instant: Instant, settings: Settings
) -> Frame:
    """Count this frame, let people in, join duplicates, let those go who are not there any more.

    Args:
        people: N people, corrected; changed in place.
        claims: M claims.
        found: Who was found by what.
        instant: When it is.
        settings: Of the tracker.
    """
    known, distance_m = len(found.hand), settings.same_person_distance_m
    next_id = _count_known(people, claims, found, instant, settings)
    mean, covariance = np.empty((1, known, 4)), np.empty((1, known, 4, 4))
    merge_modes(people.weight, people.mean, people.covariance, mean[0], covariance[0])
    free = 0
    for row in range(len(found.owner)):
        free += found.owner[row] == NOBODY
    room = with_room(people, free) if free > 0 else people
    bystander = instant.next_bystander
    newcomers, refused = let_in(
        room, known, False, bystander, mean, claims, found, instant, settings
    )
    certainty, keep = np.empty(newcomers), np.empty(known + free, np.bool_)
    for person in range(newcomers):
        certainty[person] = found.certainty[person] if person < known else 1.0
    for person in range(len(keep)):
        keep[person] = True
    merge_duplicates(room, mean, certainty, keep, distance_m)
    count, refused_hands = let_in(
        room, newcomers, True, next_id, mean, claims, found, instant, settings
    )
    for person in range(newcomers, count):
        count_person(room, person, True, 1.0, instant, settings)
    stay = 0
    for person in range(len(keep)):
        keep[person] = (
            keep[person]
            and person < count
            and is_still_there(room, person, instant.stamp_ns, settings)
        )
        stay += keep[person]
    if stay < len(keep):
        room = kept(room, keep, stay)
    for person in range(stay):
        age_ns = instant.stamp_ns - room.counts[field.BORN_NS, person]
        unseen_ns = instant.stamp_ns - room.counts[field.SEEN_NS, person]
        room.spans[field.AGE_S, person], room.spans[field.UNSEEN_S, person] = (
            age_ns / 1e9,
            unseen_ns / 1e9,
        )
    mean, covariance = np.empty((1, stay, 4)), np.empty((1, stay, 4, 4))
    merge_modes(room.weight, room.mean, room.covariance, mean[0], covariance[0])
    next_id, bystander = next_id + count - newcomers, bystander - (newcomers - known)
    return Frame(room, mean, covariance, next_id, bystander, refused + refused_hands)


@loop
def _count_known(
    people: People, claims: Claims, found: Found, instant: Instant, settings: Settings
) -> int:
    """Note what this frame told of everybody known; gives the next customer's identity.

    Bystanders who raise a hand become customers.
    """
    next_id = instant.next_id
    for row in range(len(found.owner)):
        if found.owner[row] >= 0 and claims.tag[row] >= 0:
            people.counts[field.TAG, found.owner[row]] = claims.tag[row]
    for person in range(len(found.hand)):
        people.counts[field.HAND, person] = found.hand[person]
        if found.is_called[person] and people.counts[field.ID, person] <= 0:
            people.counts[field.ID, person] = next_id
            next_id += 1
        count_person(
            people, person, found.is_called[person], found.certainty[person], instant, settings
        )
    return next_id
