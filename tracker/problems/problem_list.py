"""What was wrong with the input? Each kind once, with its count and where it began."""

from __future__ import annotations

from tracker.containers import CameraImage, FrameResult, Scan
from tracker.notes import NoteKind
from tracker.problems.clock_offset import ClockOffset
from tracker.problems.scan_use import ScanUse
from tracker.transforms import StampedTransform
from tracker.wording import counted

#: A scanner that serves fewer images than this share is worth a word.
_SERVED_SHARE, _NEVER_SHARE = 0.5, 0.1
#: Transforms that are missing for more images than this share are a fault.
_LOST_SHARE = 0.1


class Problems:
    """Counts faults and remarks by kind; memory does not grow with their number."""

    def __init__(self) -> None:
        self._faults = _Kinds()
        self._remarks = _Kinds()
        self._remarked: set[NoteKind] = set()
        self._frames = self._unlocated = 0
        self._first_unlocated = ""
        self._scan_use = ScanUse()
        self._depth_use = ScanUse(lambda kind: kind.leaves_depth_unused)
        self._parent_of: dict[str, str] = {}
        self._image_clock, self._scan_clock = ClockOffset(), ClockOffset()
        self._transform_clock = ClockOffset()

    def add(self, kind: str, text: str) -> None:
        """Note a fault; of each kind the first text is kept."""
        self._faults.add(kind, text)

    def remark(self, text: str, kind: str | None = None) -> None:
        """Note a remark; by default each text is a kind of its own."""
        self._remarks.add(kind or text, text)

    def note_arrival(self, event: object, arrived_ns: int) -> None:
        """Compare a stamp with the time of recording, and the parents of each frame."""
        if isinstance(event, CameraImage):
            self._image_clock.add(event.stamp_ns, arrived_ns)
        elif isinstance(event, Scan):
            self._scan_clock.add(event.stamp_ns, arrived_ns)
        elif isinstance(event, StampedTransform):
            self._note_parent(event.child.lstrip("/"), event.parent.lstrip("/"))
            if not event.is_static:
                self._transform_clock.add(event.stamp_ns, arrived_ns)

    def note_frame(self, result: FrameResult) -> None:
        """Pick the faults from what the pipeline noted about one image."""
        self._scan_use.add(result)
        self._depth_use.add(result)
        self._frames += 1
        for note in result.notes:
            if note.kind is NoteKind.NO_POSE:
                self._unlocated += 1
                self._first_unlocated = self._first_unlocated or note.text
            if note.kind.is_fault:
                self.add(note.kind.value, f"{note} (image at {result.stamp_ns / 1e9:.3f} s)")
            elif note.kind.is_remark and note.kind not in self._remarked:
                self._remarked.add(note.kind)
                self.remark(note.text)

    def note_poses(self) -> None:
        """Say that transforms were missing for a part of the images."""
        if not self._unlocated:
            return
        text = (
            f"{self._first_unlocated.rstrip('.')} (so in {self._unlocated} of "
            f"{counted(self._frames, 'image')}: no pose there, and no position in the fixed frame)"
        )
        if self._unlocated > _LOST_SHARE * self._frames:
            self.add("missing transforms", text)
        else:
            self.remark(text)

    @property
    def transforms_late_s(self) -> float:
        """How much later transforms were recorded than images of the same stamp."""
        return self._image_clock.ahead_s() - self._transform_clock.ahead_s()

    def note_scan_use(self, max_age_s: float) -> None:
        """Report scans that could not be used.

        Args:
            max_age_s: `scan_max_age_s`: stamps that are farther off make a scan useless.
        """
        ahead_s = self._scan_clock.ahead_s() - max(self._image_clock.ahead_s(), 0.0)
        if ahead_s > max_age_s:
            self.add(
                "scan clock ahead",
                f"the scans' stamps lie {ahead_s:.3f} s after their recording, the images' do "
                "not: the clocks of scanner and camera disagree, and scans are used for images of "
                "another time. Synchronize the clocks, or replay with --stamps log.",
            )
        use = self._scan_use
        if use.frames and use.used <= _NEVER_SHARE * use.frames:
            images = counted(use.frames, "image")
            few = f"a scan was used in {use.used} of {images} only"
            text = few if use.used else f"no scan was used in any of {images}"
            self.add("scans unused", f"{text}: {use.reason()}")
        elif use.used < _SERVED_SHARE * use.frames:
            self.remark(
                f"a scan was used in {use.used} of {counted(use.frames, 'image')} only: "
                f"{use.reason()}"
            )

    def note_depth_use(self) -> None:
        """Report depth images that could not be used."""
        use = self._depth_use
        if use.frames and use.used <= _NEVER_SHARE * use.frames:
            images = counted(use.frames, "image")
            self.add("depth unused", f"depth was used in {use.used} of {images}: {use.reason()}")
        elif use.used < _SERVED_SHARE * use.frames:
            images = counted(use.frames, "image")
            self.remark(f"depth was used in {use.used} of {images} only: {use.reason()}")

    def _note_parent(self, child: str, parent: str) -> None:
        before = self._parent_of.setdefault(child, parent)
        if before != parent:
            self.add(
                f"parents of {child}",
                f"the frame {child!r} has two parents, {before!r} and {parent!r}: two publishers "
                "send its transform, and poses jump from one to the other. Stop one of them.",
            )

    def lines(self) -> tuple[str, ...]:
        """One line for each kind of fault."""
        return self._faults.lines()

    def remarks(self) -> tuple[str, ...]:
        """One line for each kind of remark."""
        return self._remarks.lines()


class _Kinds:
    """The first text of each kind, and how many came."""

    def __init__(self) -> None:
        self._first: dict[str, str] = {}
        self._count: dict[str, int] = {}

    def add(self, kind: str, text: str) -> None:
        self._first.setdefault(kind, text)
        self._count[kind] = self._count.get(kind, 0) + 1

    def lines(self) -> tuple[str, ...]:
        return tuple(
            text if self._count[kind] == 1 else f"{text} ... and {self._count[kind] - 1} more"
            for kind, text in self._first.items()
        )
