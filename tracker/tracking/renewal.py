"""Who is new, who is tracked twice, who is gone?"""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import FloatArray, Measurements
from tracker.tracking.admission import is_close
from tracker.tracking.filter import initial_state
from tracker.tracking.life_cycle import BIRTH_EXISTENCE, count_detections, still_there
from tracker.tracking.modes import Belief
from tracker.tracking.motion import modes_of
from tracker.tracking.observation import Observed
from tracker.tracking.people import People
from tracker.tracking.twins import merge_twins


def renew(seen: Observed, next_id: int, stamp_ns: int, config: Config) -> tuple[People, int]:
    """Let people in, bring twins together, and let those go who are not there any more.

    Args:
        seen: Everybody after this instant, and the measurements that are nobody's.
        next_id: The next customer's identity.
        stamp_ns: This frame's.
        config: The tracking group.

    Returns:
        Everybody from now on, and the identity of the next customer after them.
    """
    people, is_seen = seen.people, seen.is_seen
    called = seen.is_called & ~people.is_customer
    if called.any():  # bystanders who raise a hand become customers
        people = people.replace(id=np.where(called, next_id - 1 + np.cumsum(called), people.id))
        next_id += int(np.count_nonzero(called))
    place = people.belief.merged()[0][:, :2]
    if len(seen.others):
        # A second cluster beside somebody seen is their other leg; a lowered hand alone is nobody.
        bystanders, claims = _begin(seen.others, place[is_seen], stamp_ns, config)
        bystanders = bystanders[claims.hand < 0]
        people = people.append(bystanders)
        is_seen = np.append(is_seen, np.ones(len(bystanders), dtype=bool))
    people = merge_twins(people, is_seen, config)
    if len(seen.raised):
        # The second hand of somebody whose first hand has just been counted is nobody new.
        newcomers, claims = _begin(seen.raised, place[seen.is_called], stamp_ns, config)
        ids, everyone = next_id + np.arange(len(newcomers)), np.ones(len(newcomers), dtype=bool)
        newcomers = count_detections(
            newcomers.replace(id=ids), everyone, everyone, stamp_ns, config, hand=claims.hand
        )
        people, next_id = people.append(newcomers), next_id + len(newcomers)
    keep = still_there(people, stamp_ns, config)
    return (people if keep.all() else people[keep]), next_id


def _begin(
    claims: Measurements, seen_xy_m: FloatArray, stamp_ns: int, config: Config
) -> tuple[People, Measurements]:
    """The people behind claims, apart from those seen already, and their claims."""
    mean, covariance = initial_state(
        claims,
        unknown_range_m=config.unknown_range_m,
        unknown_range_std_m=config.unknown_range_std_m,
        speed_std_mps=config.initial_speed_std_mps,
    )
    new = ~is_close(mean[:, :2], seen_xy_m, config.same_person_distance_m).any(axis=1)
    belief = Belief.begin(mean[new], covariance[new], modes_of(config), config.stand_speed_std_mps)
    count = int(np.count_nonzero(new))
    ids, existence = np.zeros(count, dtype=np.int64), np.full(count, BIRTH_EXISTENCE)
    people = People.begin(ids, belief, stamp_ns, config.confirm_window, existence)
    return people, claims[new]
