"""When is a frame, and what could be seen in it?"""

from __future__ import annotations

from typing import NamedTuple

from tracker.containers import FloatArray


class Instant(NamedTuple):
    """One frame's circumstances.

    Attributes:
        stamp_ns: Of the measurements.
        dt_s: Since the last frame.
        next_id: Of the next customer.
        next_bystander: Of the next bystander, below 0.
        camera_view: Of the camera, as `view_numbers` has it.
        scan_view: Of the scan.
        has_scan: There is a scan.
        camera_looked: An image was looked at; otherwise nobody's hand was missed.
    """

    stamp_ns: int
    dt_s: float
    next_id: int
    next_bystander: int
    camera_view: FloatArray
    scan_view: FloatArray
    has_scan: bool
    camera_looked: bool
