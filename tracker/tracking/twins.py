"""Is one person tracked twice? A track that fell silent beside one that did not."""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray
from tracker.tracking.people import People

#: A track that has been silent for so long, beside somebody who is seen, is that somebody.
_SILENT_S = 0.5


def merge_twins(people: People, is_seen: BoolArray, config: Config) -> People:
    """Join each silent track with the seen one closer than `same_person_distance_m`, if any.

    The older identity goes on, with what the seen track knows of place, hand and time.

    Args:
        people: Everybody, rows by age.
        is_seen: Shape (N,): any measurement was assigned in this frame.
        config: `same_person_distance_m`.
    """
    silent = np.flatnonzero(people.missing_s > _SILENT_S)
    seen = np.flatnonzero(is_seen)
    if len(silent) == 0 or len(seen) == 0:
        return people
    mean, _ = people.belief.merged()
    apart = mean[silent, None, :2] - mean[seen, :2]
    distance = np.hypot(apart[..., 0], apart[..., 1])
    nearest = distance.argmin(axis=1)
    close = distance[np.arange(len(silent)), nearest] < config.same_person_distance_m
    if not close.any():
        return people
    keep = np.ones(len(people), dtype=bool)
    heir = np.arange(len(people))  # whose place and hand each track has from now on
    for old, young in zip(silent[close], seen[nearest[close]], strict=True):
        if old < young and keep[young]:
            heir[old] = young
            keep[young] = False
        else:
            keep[old] = False
    ids, born_ns = people.id[keep], people.born_ns[keep]
    confirmed = (people.confirmed | people.confirmed[heir])[keep]
    return people[heir[keep]].replace(id=ids, born_ns=born_ns, confirmed=confirmed)
