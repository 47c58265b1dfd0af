"""One frame of everybody: from people and measurements to people."""

from __future__ import annotations

from tracker.config import Config
from tracker.containers import Measurements
from tracker.tracking.innovations import Watch
from tracker.tracking.observation import observe
from tracker.tracking.people import People
from tracker.tracking.renewal import renew
from tracker.tracking.view import View


def track(
    people: People,
    measurements: Measurements,
    next_id: int,
    dt_s: float,
    stamp_ns: int,
    config: Config,
    view: View | None,
    scan_view: View | None,
    watch: Watch | None = None,
) -> tuple[People, int]:
    """Everybody after one instant, and the identity of the next customer.

    Args:
        people: After the last frame.
        measurements: M claims; those that no filter can live with are passed over.
        next_id: The identity of the next customer.
        dt_s: Since the last frame.
        stamp_ns: This frame's.
        config: The tracking group.
        view: Where the camera could see hands; None means everywhere.
        scan_view: Where the scan could show people; None where there is no scan.
        watch: Told of both rounds of association, raised hands first.
    """
    seen = observe(people, measurements, dt_s, stamp_ns, config, view, scan_view, watch)
    return renew(seen, next_id, stamp_ns, config)
