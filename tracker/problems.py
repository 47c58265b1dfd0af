"""What was wrong with the input? Each kind once, with its count and where it began."""

from __future__ import annotations

from tracker.containers import FrameResult


class Problems:
    """Counts faults by kind; memory does not grow with their number.

    Attributes:
        remarks: What is worth saying and is no fault, each once.
    """

    def __init__(self) -> None:
        self.remarks: list[str] = []
        self._first: dict[str, str] = {}
        self._count: dict[str, int] = {}

    def add(self, kind: str, text: str) -> None:
        """Note a fault; of each kind the first text is kept."""
        self._first.setdefault(kind, text)
        self._count[kind] = self._count.get(kind, 0) + 1

    def remark(self, text: str) -> None:
        """Note what is no fault."""
        if text not in self.remarks:
            self.remarks.append(text)

    def note_frame(self, result: FrameResult) -> None:
        """Pick the faults from what the pipeline noted about one image."""
        for note in result.notes:
            if note.kind.is_fault:
                self.add(note.kind.value, f"{note} (image at {result.stamp_ns / 1e9:.3f} s)")

    def lines(self) -> tuple[str, ...]:
        """One line for each kind of fault."""
        return tuple(
            text if self._count[kind] == 1 else f"{text} ... and {self._count[kind] - 1} more"
            for kind, text in self._first.items()
        )
