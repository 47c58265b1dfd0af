"""Is one person tracked twice? An unseen track beside a seen one is joined with it."""

from __future__ import annotations

import numpy as np

from tracker.compiling.loops import loop
from tracker.containers import BoolArray, FloatArray
from tracker.tracking import people as field
from tracker.tracking.people import People, copy_person

#: A track that has been silent for so long, beside a customer who is seen, is that customer.
SILENT_S = 0.5
#: Tracks that were followed side by side for longer are two people (guess); somebody who sets off
#: is taken for two for a moment.
TOGETHER_S = 0.5
#: Where somebody came from is known for so long back, by how they walk (guess).
CAME_FROM_S = 3.0
#: Who was out of view for nearly all of that time may still stand there: the sensors have turned
#: away (guess; behind somebody else the share is larger).
MISSED_SHARE = 0.1


@loop
def merge_duplicates(
    people: People, mean: FloatArray, certainty: FloatArray, keep: BoolArray, distance_m: float
) -> None:
    """Join each silent customer with the nearest seen track closer than a distance, in place.

    Whoever has appeared since the customer was last seen, or shortly before, is the customer, who
    set off faster than expected: the older identity goes on, with what the seen track knows of
    place, hand and time. Whoever was followed beside the customer before is somebody else. A
    bystander is left alone then; a customer stays who they are, and the silent track, which has
    strayed there, ends.

    Args:
        people: Everybody, those who have just come last.
        mean: Shape (1, N, 4): of those who were there before.
        certainty: Shape (P,): of all; above 0 for whom a measurement showed in this frame.
        keep: Set to false for whoever is joined with somebody else.
        distance_m: `same_person_distance_m`.
    """
    for silent in range(mean.shape[1]):
        if certainty[silent] > 0.0 or people.counts[field.ID, silent] <= 0:
            continue
        seen = _nearest_duplicate(people, mean, certainty, silent, distance_m)
        if seen < 0:
            continue
        is_customer = people.counts[field.ID, seen] > 0
        is_older = (
            not is_customer or people.counts[field.ID, silent] < people.counts[field.ID, seen]
        )
        if is_older and keep[seen] and not _were_together(people, silent, seen):
            keep[seen] = False
            _inherit(people, silent, seen)
        else:
            keep[silent] = False


@loop
def _nearest_duplicate(
    people: People, mean: FloatArray, certainty: FloatArray, silent: int, distance_m: float
) -> int:
    """Row of the seen track that may be the same person, or -1."""
    nearest, least = -1, distance_m
    for seen in range(len(certainty)):
        if certainty[seen] == 0.0:
            continue
        together = is_apart = _were_together(people, silent, seen)
        if people.counts[field.ID, seen] > 0:
            is_apart = people.spans[field.MISSING_S, silent] <= SILENT_S
        apart_m = _apart_m(people, mean, silent, seen, together)
        if not is_apart and apart_m < least:
            nearest, least = seen, apart_m
    return nearest


@loop
def _apart_m(people: People, mean: FloatArray, silent: int, seen: int, together: bool) -> float:
    """Distance of a seen track from a silent one: now, or when that was last seen if it was less.

    Somebody who sets off, half hidden, may be found again only after a few steps. They walk, and
    come from where the silent one was; furniture has never been anywhere else.
    """
    state = mean[0, seen] if seen < mean.shape[1] else people.mean[0, seen]
    dx, dy = state[0] - mean[0, silent, 0], state[1] - mean[0, silent, 1]
    apart_m = np.sqrt(dx * dx + dy * dy)
    passed_s = (people.counts[field.SEEN_NS, seen] - people.counts[field.SEEN_NS, silent]) / 1e9
    was_missed = people.spans[field.MISSING_S, silent] >= MISSED_SHARE * passed_s
    # If both were followed together, it is known where each of them was.
    if not together and was_missed and passed_s <= CAME_FROM_S:
        dx, dy = dx - state[2] * passed_s, dy - state[3] * passed_s
        apart_m = min(apart_m, np.sqrt(dx * dx + dy * dy))
    return apart_m


@loop
def _were_together(people: People, silent: int, seen: int) -> bool:
    together_s = (people.counts[field.SEEN_NS, silent] - people.counts[field.BORN_NS, seen]) / 1e9
    return together_s > TOGETHER_S


@loop
def _inherit(people: People, row: int, heir: int) -> None:
    """Move a customer's identity and history to the track that continues."""
    counts = people.counts
    id, born_ns = counts[field.ID, row], counts[field.BORN_NS, row]
    detections, called_ns = counts[field.DETECTIONS, row], counts[field.CALLED_NS, row]
    was_confirmed = people.flags[field.CONFIRMED, row]
    copy_person(people, heir, people, row)
    counts[field.ID, row], counts[field.BORN_NS, row] = id, born_ns
    counts[field.DETECTIONS, row] = max(counts[field.DETECTIONS, row], detections)
    counts[field.CALLED_NS, row] = max(counts[field.CALLED_NS, row], called_ns)
    if was_confirmed:
        people.flags[field.CONFIRMED, row] = True
