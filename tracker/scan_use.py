"""Is the LiDAR of any use? A scanner of which nothing is used must not go unnoticed."""

from __future__ import annotations

from collections import Counter

from tracker.containers import FrameResult
from tracker.notes import NoteKind

_REMEDIES = {
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

    Attributes:
        frames: Images since the beginning, or since `reset`.
        used: Those of them for which a scan showed something.
    """

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Start counting again."""
        self.frames = self.used = 0
        self._kinds: Counter[NoteKind] = Counter()
        self._first: dict[NoteKind, str] = {}

    def add(self, result: FrameResult) -> None:
        """Take in what one image led to."""
        self.frames += 1
        reasons = [note for note in result.notes if note.kind.leaves_scan_unused]
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
