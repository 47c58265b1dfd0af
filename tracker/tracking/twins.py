"""Is one person tracked twice? A track that fell silent beside one that did not."""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray
from tracker.tracking.people import People

#: A track that has been silent for so long, beside a customer who is seen, is that customer.
SILENT_S = 0.5


def merge_twins(people: People, is_seen: BoolArray, config: Config) -> People:
    """Join each silent customer with the seen track closer than `same_person_distance_m`, if any.

    The older identity goes on, with what the seen track knows of place, hand and time. A bystander
    who was there while the customer was still seen is somebody else; one who has appeared since is
    the customer, who set off faster than expected. People whose clothes rather speak for two are
    no twins.

    Args:
        people: Everybody.
        is_seen: Shape (N,): any measurement was assigned in this frame.
        config: `same_person_distance_m`, `appearance_weight`.
    """
    silent = np.flatnonzero(~is_seen & people.is_customer)
    seen = np.flatnonzero(is_seen)
    if len(silent) == 0 or len(seen) == 0:
        return people
    mean, _ = people.belief.merged()
    apart = mean[silent, None, :2] - mean[seen, :2]
    distance = np.hypot(apart[..., 0], apart[..., 1])
    is_other = np.where(
        people.is_customer[seen],
        people.missing_s[silent, None] <= SILENT_S,
        people.born_ns[seen] <= people.seen_ns[silent, None],
    )
    distance[is_other] = np.inf
    nearest = distance.argmin(axis=1)
    close = distance[np.arange(len(silent)), nearest] < config.same_person_distance_m
    clothes = people.appearance
    if config.appearance_weight and close.any():
        close &= clothes.log_ratio(clothes.histogram, silent, seen[nearest]) >= 0.0
    if not close.any():
        return people
    keep = np.ones(len(people), dtype=bool)
    heir = np.arange(len(people))  # whose place and hand each track has from now on
    for mute, heard in zip(silent[close], seen[nearest[close]], strict=True):
        older = not people.is_customer[heard] or people.id[mute] < people.id[heard]
        if older and keep[heard]:
            heir[mute] = heard
            keep[heard] = False
        else:
            keep[mute] = False
    # What a customer has been counts on.
    return people[heir][keep].replace(
        id=people.id[keep],
        born_ns=people.born_ns[keep],
        confirmed=(people.confirmed | people.confirmed[heir])[keep],
        detections=np.maximum(people.detections, people.detections[heir])[keep],
        called_ns=np.maximum(people.called_ns, people.called_ns[heir])[keep],
        appearance=clothes.remember(clothes.histogram, heir)[keep],
    )
