"""Who stands in the scan? Person-sized segments, legs paired, as positions in the fixed frame.

Segmentation by jump distance, a filter on the width, and pairing of legs. Walls and furniture that
are wider than a body are background; what is thinner than a leg (table legs, chair legs) is not
a person either.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray, LocatedScan

#: A trouser leg is about 0.12 to 0.2 m across; a table leg 0.03 to 0.06 m.
LEG_WIDTH_MIN_M = 0.075
#: Wider than this is a body, a skirt or both legs in one, and needs no second leg.
LEG_WIDTH_MAX_M = 0.26
#: Centers of the two legs of one person who walks are no farther apart than this.
LEG_PAIR_DISTANCE_M = 0.45
#: What the laser sees is the near skin; the middle of a leg lies about this far behind it.
LEG_RADIUS_M = 0.06
#: So many beams in a row without return are a drop-out; more are a gap.
_DROPOUT_BEAMS = 2


@dataclass(frozen=True, slots=True, eq=False)
class PersonClusters:
    """Person-sized things of one scan; row i of each array is the same one.

    Attributes:
        xy_m: Shape (C, 2): supposed middle of the body, in the fixed frame.
        width_m: Shape (C,): from the first to the last point.
        legs: Shape (C,), int64: segments it was put together from.
    """

    xy_m: FloatArray
    width_m: FloatArray
    legs: IntArray

    def __len__(self) -> int:
        return len(self.xy_m)

    @staticmethod
    def none() -> PersonClusters:
        """Nobody."""
        return PersonClusters(np.zeros((0, 2)), np.zeros(0), np.zeros(0, dtype=np.int64))


def find_people(
    scan: LocatedScan,
    *,
    segment_jump_m: float,
    body_width_m: float,
    range_max_m: float,
) -> PersonClusters:
    """Find what could be a person at the height of the laser.

    Args:
        scan: The scan, in the fixed frame.
        segment_jump_m: Neighboring points farther apart than this part segments.
        body_width_m: Wider segments are background.
        range_max_m: Segments all of which is farther are left alone.

    Returns:
        The clusters, by angle around the laser.
    """
    rows = np.flatnonzero(scan.valid)
    if len(rows) == 0:
        return PersonClusters.none()
    rows, begins = _segments(scan, rows, segment_jump_m)
    range_m, points = scan.range_m[rows], scan.xy_m[rows]
    heading = scan.heading_rad[rows]
    direction = np.stack([np.cos(heading), np.sin(heading)], axis=-1)

    count = np.diff(np.append(begins, len(rows)))
    extent = np.maximum.reduceat(points, begins) - np.minimum.reduceat(points, begins)
    width = np.hypot(extent[:, 0], extent[:, 1])
    # The outermost beams miss the edges by up to one spacing in all.
    spacing = range_m[begins] * scan.spacing_rad
    person_sized = (width + spacing >= LEG_WIDTH_MIN_M) & (width <= body_width_m) & (count >= 2)
    # Judged as a whole: a wall that runs out of range is not cut down to a person.
    person_sized &= np.minimum.reduceat(range_m, begins) <= range_max_m
    person_sized &= ~_is_seen_through_gap(scan, rows, begins, segment_jump_m)
    middle = np.add.reduceat(points + LEG_RADIUS_M * direction, begins) / count[:, None]
    return _pair_legs(middle[person_sized], width[person_sized])


def _segments(scan: LocatedScan, rows: IntArray, jump_m: float) -> tuple[IntArray, IntArray]:
    """Beams with a return in an order without a seam, and where in it each segment begins.

    Args:
        scan: The scan.
        rows: Shape (K,): beams with a return.
        jump_m: Neighboring points farther apart than this part segments.

    Returns:
        The same beams, turned so that the first begins a segment; and positions among them.
    """
    points = scan.xy_m[rows]
    step = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=-1)
    skipped = (np.roll(rows, -1) - rows) % len(scan)
    # Far away the beams themselves spread.
    spacing = scan.range_m[rows] * scan.spacing_rad
    ends = (step > np.maximum(jump_m, 2.5 * spacing)) | (skipped > _DROPOUT_BEAMS + 1)
    if not scan.is_full_turn:
        ends[-1] = True
    last = np.flatnonzero(ends)
    if len(last) == 0:  # one closed ring around the scanner
        return rows, np.zeros(1, dtype=np.int64)
    turn = int(last[-1]) + 1
    begins = np.append(0, (last[:-1] + 1 - turn) % len(rows))
    return np.roll(rows, -turn), np.sort(begins)


def _is_seen_through_gap(
    scan: LocatedScan, rows: IntArray, begins: IntArray, jump_m: float
) -> BoolArray:
    """Segments with something nearer on both sides: a wall between two legs is not foreground."""
    ends = np.append(begins[1:], len(rows)) - 1
    first, last = rows[begins], rows[ends]
    before, after = np.roll(last, 1), np.roll(first, -1)
    range_m, beams = scan.range_m, len(scan)
    covered_before = ((first - before) % beams <= _DROPOUT_BEAMS + 1) & (
        range_m[before] < range_m[first] - jump_m
    )
    covered_after = ((after - last) % beams <= _DROPOUT_BEAMS + 1) & (
        range_m[after] < range_m[last] - jump_m
    )
    return np.asarray(covered_before & covered_after)


def _pair_legs(centers: FloatArray, width: FloatArray) -> PersonClusters:
    """Join leg-sized segments two by two, the closest pairs first."""
    count = len(centers)
    legs = width <= LEG_WIDTH_MAX_M
    distance = np.linalg.norm(centers[:, None] - centers[None], axis=-1)
    pairs = legs[:, None] & legs[None] & (distance <= LEG_PAIR_DISTANCE_M)
    candidates = np.argwhere(np.triu(pairs, k=1))
    candidates = candidates[np.argsort(distance[tuple(candidates.T)], kind="stable")]
    partner = np.full(count, -1)
    for a, b in candidates:
        if partner[a] < 0 and partner[b] < 0:
            partner[a], partner[b] = b, a
    keep = (partner < 0) | (partner > np.arange(count))
    xy = np.where((partner >= 0)[:, None], (centers + centers[partner]) / 2, centers)
    total = np.where(partner >= 0, width + distance[np.arange(count), partner], width)
    return PersonClusters(xy[keep], total[keep], np.where(partner >= 0, 2, 1)[keep])
