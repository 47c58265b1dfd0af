"""Who is new? One person for the measurements that belong to no known person."""

from __future__ import annotations

from tracker.compiling.loops import loop, maker
from tracker.containers import FloatArray
from tracker.tracking.association.admission import is_one_sensor
from tracker.tracking.association.found import NOBODY, Found
from tracker.tracking.association.gating import distance_of
from tracker.tracking.instant import Instant
from tracker.tracking.life_cycle.births import begin_person, is_apart
from tracker.tracking.people import People
from tracker.tracking.sensing.claims import Claims
from tracker.tracking.sensing.sensor_kinds import BEARING, RANGE, begin
from tracker.tracking.settings import Settings
from tracker.tracking.update.correction import correct_by


@maker
def let_in(
    room: People,
    first: int,
    is_raised: bool,
    next_id: int,
    mean: FloatArray,
    claims: Claims,
    found: Found,
    instant: Instant,
    settings: Settings,
) -> tuple[int, int]:
    """Begin a track for everybody new, in place.

    What a second sensor says of a newcomer, or the same one of the same body, corrects the track,
    if it fits; what else is said of the body of somebody known is theirs, and shows nobody new.
    A second cluster beside somebody seen is their other leg, and a second hand of whoever has just
    called is theirs; a lowered hand alone is nobody.

    Args:
        room: Of everybody, with room for as many more.
        first: Row of the first newcomer.
        is_raised: By raised hands, or by everything else.
        next_id: Of the first newcomer; customers count up, bystanders down.
        mean: Shape (1, N, 4): of those who were there before.
        claims: M claims.
        found: Whose each of them is; newcomers are noted.
        instant: When it is.
        settings: Of the tracker.

    Returns:
        The row after the last newcomer, and how many measurements could show nobody.
    """
    count, refused = first, 0
    for row in range(len(found.owner)):
        if found.owner[row] != NOBODY or claims.raised[row] != is_raised:
            continue
        if not is_raised and claims.hand[row] >= 0:
            continue
        person = _person_of(room, first, claims, found, row, settings)
        if person >= 0:
            found.owner[row] = person
            if person >= first and _fits(room, person, claims, row, settings):
                correct_by(room, person, claims, row, settings.outlier_dof)
            continue
        if claims.kind[row] == RANGE:  # somewhere on a ring
            refused += 1
            continue
        place = begin(claims.kind[row], claims, row, settings)
        if is_apart(found, mean, is_raised, place[0], place[1], settings.same_person_distance_m):
            id = next_id + (count - first) * (1 if is_raised else -1)
            begin_person(room, count, id, place, claims, row, instant.stamp_ns, settings)
            found.owner[row] = count
            count += 1
    return count, refused


@loop
def _person_of(
    room: People, first: int, claims: Claims, found: Found, row: int, settings: Settings
) -> int:
    """Row of the newcomer to whom a measurement also belongs, or -1."""
    for other in range(len(found.owner)):
        person = found.owner[other]
        if person < 0 or claims.raised[other] != claims.raised[row]:
            continue
        if claims.body[row] >= 0 and claims.body[row] == claims.body[other]:
            return person
        if claims.tag[row] >= 0 and claims.tag[row] == claims.tag[other]:
            return person
        if person < first or is_one_sensor(claims, row, other):
            continue
        if _fits(room, person, claims, row, settings):
            if claims.kind[row] == RANGE or claims.kind[row] == BEARING:
                return person
            x, y, _, _, _ = begin(claims.kind[row], claims, row, settings)
            dx, dy = x - room.mean[0, person, 0], y - room.mean[0, person, 1]
            if dx * dx + dy * dy < settings.same_person_distance_m**2:
                return person
    return -1


@loop
def _fits(room: People, newcomer: int, claims: Claims, row: int, settings: Settings) -> bool:
    """Whether a claim is inside a newcomer's gate."""
    distance, _ = distance_of(room.mean, room.covariance, 0, newcomer, claims, row, settings)
    return distance <= settings.ranged_limit
