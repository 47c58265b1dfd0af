"""How does a track begin, and where must none begin?"""

from __future__ import annotations

from tracker.compiling.loops import loop
from tracker.containers import FloatArray
from tracker.tracking import people as field
from tracker.tracking.association.found import Found
from tracker.tracking.life_cycle.life_cycle import BIRTH_EXISTENCE
from tracker.tracking.people import People
from tracker.tracking.sensing.claims import Claims
from tracker.tracking.settings import Settings
from tracker.tracking.update.bias import BIAS


@loop
def begin_person(
    room: People,
    row: int,
    id: int,
    place: tuple[float, float, float, float, float],
    claims: Claims,
    claim: int,
    stamp_ns: int,
    settings: Settings,
) -> None:
    """Write a newcomer into a row: walking and standing are equally likely, all counts are zero.

    Args:
        room: Of everybody.
        row: The newcomer's.
        id: Above 0 for a customer, below for a bystander.
        place: x, y and their covariance (xx, xy, yy).
        claims: M claims.
        claim: The one that shows the newcomer.
        stamp_ns: This frame's.
        settings: Of the tracker.
    """
    x, y, xx, xy, yy = place
    modes = len(room.weight)
    for mode in range(modes):
        mean, covariance = room.mean, room.covariance
        speed_std_mps = settings.initial_speed_std_mps
        if mode == 1:  # who stands hardly moves
            speed_std_mps = settings.stand_speed_std_mps
        for i in range(4):
            mean[mode, row, i] = 0.0
            for j in range(4):
                covariance[mode, row, i, j] = 0.0
        room.weight[mode, row], mean[mode, row, 0], mean[mode, row, 1] = 1.0 / modes, x, y
        covariance[mode, row, 0, 0], covariance[mode, row, 1, 1] = xx, yy
        covariance[mode, row, 0, 1] = covariance[mode, row, 1, 0] = xy
        covariance[mode, row, 2, 2] = covariance[mode, row, 3, 3] = speed_std_mps**2
    counts = room.counts
    for item in range(len(counts)):
        counts[item, row] = 0
    counts[field.ID, row], counts[field.TAG, row] = id, claims.tag[claim]
    counts[field.HAND, row], counts[field.RAISED_SINCE_NS, row] = claims.hand[claim], -1
    counts[field.BORN_NS, row] = counts[field.SEEN_NS, row] = counts[field.CALLED_NS, row] = (
        stamp_ns
    )
    room.spans[field.EXISTENCE, row], room.spans[field.MISSING_S, row] = BIRTH_EXISTENCE, 0.0
    for item, i, j in BIAS:
        room.spans[item, row] = claims.bias[claim, i, j]
    room.flags[field.RAISED, row] = room.flags[field.CONFIRMED, row] = False
    for age in range(room.recent.shape[1]):
        room.recent[row, age] = False


@loop
def is_apart(
    found: Found, mean: FloatArray, is_raised: bool, x: float, y: float, distance_m: float
) -> bool:
    """Whether nobody stands at a place who has just called, or been seen at all.

    Args:
        found: Who was found.
        mean: Shape (1, N, 4): of those who were there before.
        is_raised: Only who has called counts.
        x: Of the place.
        y: Of the place.
        distance_m: Closer than this is the same place.
    """
    for person in range(len(found.hand)):
        counts = found.is_called[person] if is_raised else found.certainty[person] > 0.0
        dx, dy = x - mean[0, person, 0], y - mean[0, person, 1]
        if counts and dx * dx + dy * dy < distance_m**2:
            return False
    return True
