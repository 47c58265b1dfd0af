"""What does the tracker return?"""

from __future__ import annotations

import numpy as np

from tracker.containers import IntArray, Tracks
from tracker.containers.arrays import COUNTS, constant, sealed
from tracker.containers.rows import trusted
from tracker.tracking import people as field
from tracker.tracking.life_cycle.renewal import Frame
from tracker.tracking.update.bias import BIAS


def customers_of(frame: Frame) -> IntArray | None:
    """Rows of those who have called, by identity; None where that is everybody, in order."""
    ids = frame.people.counts[field.ID].tolist()  # few numbers are compared faster one by one
    if ids == sorted(ids) and (not ids or ids[0] > 0):
        return None  # nearly always, without a scan
    order = np.argsort(ids, kind="stable")
    return order[np.count_nonzero(frame.people.counts[field.ID] <= 0) :]


def tracks_of(frame: Frame, stamp_ns: int, rows: IntArray | None) -> Tracks:
    """Some of the people of a frame, as `Tracks`; nobody is selected yet.

    Args:
        frame: After this instant.
        stamp_ns: This frame's.
        rows: Of people; None for all.
    """
    people = frame.people
    counts, flags, spans = people.counts, people.flags, people.spans
    mean, covariance = frame.mean[0], frame.covariance[0]
    if rows is not None:
        counts, flags, spans = counts[:, rows], flags[:, rows], spans[:, rows]
        mean, covariance = mean[rows], covariance[rows]
    counts, flags, spans = sealed(counts[:]), sealed(flags[:]), sealed(spans[:])
    mean, covariance = sealed(mean[:]), covariance.copy()
    for item, i, j in BIAS:
        covariance[:, i, j] += spans[item]
    return trusted(
        Tracks,
        stamp_ns=stamp_ns,
        id=counts[field.ID],
        mean=mean,
        covariance=sealed(covariance),
        existence=spans[field.EXISTENCE],
        confirmed=flags[field.CONFIRMED],
        raised=flags[field.RAISED],
        raised_since_ns=counts[field.RAISED_SINCE_NS],
        age_s=spans[field.AGE_S],
        unseen_s=spans[field.UNSEEN_S],
        hand=counts[field.HAND],
        selected_id=None,
        refused=frame.refused,
        gesture=constant(0, (len(mean),), COUNTS),
    )
