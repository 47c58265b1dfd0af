"""Which neighboring beams hit the same thing, and what is its shape?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray, LocatedScan

#: So many beams in a row without return are a drop-out; more are a gap.
_DROPOUT_BEAMS = 2


@dataclass(frozen=True, slots=True, eq=False)
class Segments:
    """Things one beside the other, by angle around the laser; row i of each array is one.

    Attributes:
        rows: Shape (K,): beams with a return, without a seam; each segment is a part of them.
        begins: Shape (S,): where in `rows` each segment begins.
        beams: Shape (S,): how many of them it has.
        range_m: Shape (S,): level distance of its nearest beam.
        width_m: Shape (S,): from its first point to its last.
        spacing_m: Shape (S,): between two beams at its distance.
        flatness: Shape (S,): spread of its points across the line through them, by that along it.
            The near side of a round thing has about .3, of a flat body .15, a board 0 and noise.
        stands_free: Shape (S,): what is beside it on both sides is farther, by `_FREE_M`.
        is_in_gap: Shape (S,): what is beside it on both sides is nearer: a wall between two legs.
    """

    rows: IntArray
    begins: IntArray
    beams: IntArray
    range_m: FloatArray
    width_m: FloatArray
    spacing_m: FloatArray
    flatness: FloatArray
    stands_free: BoolArray
    is_in_gap: BoolArray


#: What stands free is at least so far in front of what is beside it (guess).
_FREE_M = 0.5


def find_segments(scan: LocatedScan, jump_m: float) -> Segments:
    """Part a scan where neighboring points are farther apart than `jump_m`.

    Args:
        scan: The scan, with a valid beam.
        jump_m: Far away, where the beams themselves spread, it takes more.
    """
    rows, begins = _part(scan, np.flatnonzero(scan.valid), jump_m)
    points, range_m = scan.xy_m[rows], scan.range_m[rows]
    beams = np.diff(np.append(begins, len(rows)))
    extent = np.maximum.reduceat(points, begins) - np.minimum.reduceat(points, begins)
    stands_free, is_in_gap = _beside(scan, rows, begins, jump_m)
    return Segments(
        rows=rows,
        begins=begins,
        beams=beams,
        range_m=np.minimum.reduceat(range_m, begins),
        width_m=np.hypot(extent[:, 0], extent[:, 1]),
        spacing_m=range_m[begins] * scan.spacing_rad,
        flatness=_flatness(points, begins, beams),
        stands_free=stands_free,
        is_in_gap=is_in_gap,
    )


def _part(scan: LocatedScan, rows: IntArray, jump_m: float) -> tuple[IntArray, IntArray]:
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


def _flatness(points: FloatArray, begins: IntArray, beams: IntArray) -> FloatArray:
    """Square root of the ratio of the principal variances of each segment's points."""
    middle = np.add.reduceat(points, begins) / beams[:, None]
    x, y = (points - np.repeat(middle, beams, axis=0)).T
    xx, yy, xy = np.add.reduceat(np.stack([x * x, y * y, x * y]), begins, axis=1) / beams
    mean, apart = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    return np.asarray(np.sqrt(np.maximum(mean - apart, 0.0) / np.maximum(mean + apart, 1e-12)))


def _beside(
    scan: LocatedScan, rows: IntArray, begins: IntArray, jump_m: float
) -> tuple[BoolArray, BoolArray]:
    """Whether what is beside each segment, on both sides, is farther; and whether it is nearer."""
    first, last = rows[begins], rows[np.append(begins[1:], len(rows)) - 1]
    free, gap = np.ones(len(begins), dtype=bool), np.ones(len(begins), dtype=bool)
    for own, other, skipped in (
        (first, np.roll(last, 1), first - np.roll(last, 1)),
        (last, np.roll(first, -1), np.roll(first, -1) - last),
    ):
        adjoins = skipped % len(scan) <= _DROPOUT_BEAMS + 1
        behind_m = scan.range_m[other] - scan.range_m[own]
        free &= ~adjoins | (behind_m > _FREE_M)
        gap &= adjoins & (behind_m < -jump_m)
    return free, gap
