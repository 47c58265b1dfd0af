"""Is one person tracked twice? A track that fell silent beside one that did not."""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray
from tracker.tracking.people import People

#: A track that has been silent for so long, beside a customer who is seen, is that customer.
SILENT_S = 0.5
#: Tracks that were followed side by side for longer are two people (guess); somebody who sets off
#: is taken for two for a moment.
TOGETHER_S = 0.5


def merge_twins(people: People, is_seen: BoolArray, config: Config) -> People:
    """Join each silent customer with the seen track closer than `same_person_distance_m`, if any.

    Whoever has appeared since the customer was last seen, or shortly before, is the customer, who
    set off faster than expected: the older identity goes on, with what the seen track knows of
    place, hand and time. Whoever was followed beside the customer before is somebody else. A
    bystander is left alone then; a customer stays who they are, and the silent track, which has
    strayed there, ends.

    Args:
        people: Everybody.
        is_seen: Shape (N,): any measurement was assigned in this frame.
        config: `same_person_distance_m`.
    """
    silent = np.flatnonzero(~is_seen & people.is_customer)
    seen = np.flatnonzero(is_seen)
    if len(silent) == 0 or len(seen) == 0:
        return people
    mean, _ = people.belief.merged()
    apart = mean[silent, None, :2] - mean[seen, :2]
    distance = np.hypot(apart[..., 0], apart[..., 1])
    is_other = (people.seen_ns[silent, None] - people.born_ns[seen]) / 1e9 > TOGETHER_S
    is_older = ~people.is_customer[seen] | (people.id[silent, None] < people.id[seen])
    goes_on = is_older & ~is_other
    is_apart = np.where(
        people.is_customer[seen], people.missing_s[silent, None] <= SILENT_S, is_other
    )
    distance[is_apart] = np.inf
    nearest = distance.argmin(axis=1)
    rows = np.arange(len(silent))
    close = distance[rows, nearest] < config.same_person_distance_m
    goes_on = goes_on[rows, nearest]
    if not close.any():
        return people
    keep = np.ones(len(people), dtype=bool)
    heir = np.arange(len(people))  # whose place and hand each track has from now on
    pairs = zip(silent[close], seen[nearest[close]], goes_on[close], strict=True)
    for mute, heard, is_alive in pairs:
        if is_alive and keep[heard]:
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
    )
