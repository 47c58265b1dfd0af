"""Is a scan in meters and radians, with a plausible number of beams?

Some drivers send millimeters or degrees. No planar scanner's returns are all farther than any
room, and none turns twice in one scan: such numbers are in another unit, and are converted.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracker.containers import FloatArray, Scan
from tracker.notes import Note, NoteKind

#: No 2-D scanner sees farther, those of cars included; in millimeters it is not even a step.
_METERS_MAX = 300.0
#: In millimeters nothing is nearer than this: scanners see nothing nearer than two centimeters.
_MILLIMETERS_MIN = 20.0
#: In millimeters half of the returns are at least this far; one in centimeters has less.
_ROOM_MIN_M = 0.6
#: A range limit from here on is in millimeters, where the ranges are.
_RANGE_MIN_MAX_M = 1.0
#: A scan that turns farther than twice is in degrees: even 30 of them would be 4.8 turns.
_SPAN_MAX_RAD = 4 * np.pi
#: The finest scanners have 25 000 beams in a turn; more than this are thinned out.
BEAMS_MAX = 32_768


def mend_scan(scan: Scan) -> tuple[Scan, tuple[Note, ...]]:
    """The scan in meters and radians with a limited number of beams, and notes on the changes.

    What cannot be told for sure, as of a scan with few returns, is left as it came.
    """
    notes = []
    if len(scan.ranges_m) > BEAMS_MAX:
        beams, step = len(scan.ranges_m), -(-len(scan.ranges_m) // BEAMS_MAX)
        scan = _every(scan, step)
        text = f"the scan has {beams} beams; one in {step} is used, so at most {BEAMS_MAX}"
        notes.append(Note(NoteKind.SCAN_THINNED, text))
    span_rad = abs(scan.angle_increment_rad) * (len(scan.ranges_m) - 1)
    if _SPAN_MAX_RAD < span_rad <= 720.0:
        text = (
            f"the scan's angles span {span_rad:.0f} rad: treated as degrees. The driver should "
            "send radians (REP 103)"
        )
        notes.append(Note(NoteKind.SCAN_IN_DEGREES, text))
        scan = replace(
            scan,
            angle_min_rad=float(np.radians(scan.angle_min_rad)),
            angle_increment_rad=float(np.radians(scan.angle_increment_rad)),
        )
    if _is_in_millimeters(scan.ranges_m):
        text = (
            "the scan's ranges are hundreds of meters and more, with a range_max of "
            f"{scan.range_max_m:g}: treated as millimeters. The driver should send meters (REP "
            "103)"
        )
        notes.append(Note(NoteKind.SCAN_IN_MILLIMETERS, text))
        scan = _from_millimeters(scan)
    return scan, tuple(notes)


def _every(scan: Scan, step: int) -> Scan:
    return replace(
        scan,
        ranges_m=scan.ranges_m[::step],
        angle_increment_rad=scan.angle_increment_rad * step,
        time_increment_s=scan.time_increment_s * step,
    )


def _returns(ranges: FloatArray) -> FloatArray:
    """Positive finite ranges; the farthest one may be the driver's word for "no return"."""
    found = ranges[np.isfinite(ranges) & (ranges > 0.0)]
    return np.asarray(found[found < found.max(initial=0.0)])


def _is_in_millimeters(ranges: FloatArray) -> bool:
    if not (np.isfinite(ranges) & (ranges > _METERS_MAX)).any():
        return False  # almost always
    found = _returns(ranges)
    if len(found) < 3:
        return False
    near, middle, far = np.percentile(found, [5.0, 50.0, 90.0])
    is_room = middle / 1000.0 >= _ROOM_MIN_M  # in centimeters it would be a cupboard
    return bool(near >= _MILLIMETERS_MIN and far > _METERS_MAX and is_room)


def _from_millimeters(scan: Scan) -> Scan:
    """Limits are converted where they are in millimeters too."""
    low, high = scan.range_min_m, scan.range_max_m
    return replace(
        scan,
        ranges_m=scan.ranges_m / 1000.0,
        range_min_m=low / 1000.0 if low >= _RANGE_MIN_MAX_M else low,
        range_max_m=high / 1000.0 if high > _METERS_MAX else high,
    )
