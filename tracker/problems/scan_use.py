"""How often is a sensor used? A sensor whose data are never used must be reported."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable

from tracker.containers import FrameResult
from tracker.notes import NoteKind

_REMEDIES = {
    NoteKind.NO_DEPTH: "Remap `depth`, and set depth_transport",
    NoteKind.DEPTH_TOO_OLD: "Do the clocks of both cameras agree? If so, raise scan_max_age_s",
    NoteKind.DEPTH_NOT_LOCATED: "A transform must connect the depth camera's frame with "
    "fixed_frame at the depth image's stamp",
    NoteKind.DEPTH_UNREADABLE: "Check the driver's encoding and its depth_camera_info",
    NoteKind.SCAN_TOO_OLD: "Do the clocks of camera and scanner agree? If they do, raise "
    "scan_max_age_s",
    NoteKind.SCAN_NOT_LOCATED: "A transform must connect the scanner's frame with fixed_frame at "
    "the scan's stamp",
    NoteKind.SCAN_TOO_STEEP: "A scanner that sees people turns about a vertical axis",
    NoteKind.SCAN_WITHOUT_BEAMS: "Check the driver's angles",
    NoteKind.SCAN_WITHOUT_RETURNS: "Check the driver's ranges, range_min and range_max",
}


class ScanUse:
    """Counts the images for which a scan was used, and why not for the others.

    Args:
        leaves_unused: Which kinds of notes are such a reason; by default those about scans.

    Attributes:
        frames: Images since the beginning, or since `reset`.
        used: Images for which the sensor was used.
    """

    def __init__(
        self,
        leaves_unused: Callable[[NoteKind], bool] = lambda kind: kind.leaves_scan_unused,
    ) -> None:
        self._leaves_unused = leaves_unused
        self.reset()

    def reset(self) -> None:
        """Start counting again."""
        self.frames = self.used = 0
        self._kinds: Counter[NoteKind] = Counter()
        self._first: dict[NoteKind, str] = {}

    def add(self, result: FrameResult) -> None:
        """Count the result of one image."""
        self.frames += 1
        reasons = [note for note in result.notes if self._leaves_unused(note.kind)]
        self.used += not reasons
        for note in reasons:
            self._kinds[note.kind] += 1
            self._first.setdefault(note.kind, note.text)

    def reason(self) -> str:
        """Why images got no scan: the most frequent reason, with its remedy; empty for none."""
        if not self._kinds:
            return ""
        ((kind, _),) = self._kinds.most_common(1)
        remedy = _REMEDIES.get(kind)
        text = self._first[kind].rstrip(".")
        return f"{text}. {remedy}." if remedy else f"{text}."
