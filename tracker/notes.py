"""What was missing or odd about an image? A kind for code, and a text for people."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class NoteKind(Enum):
    """What a note is about; the value is its name in files and diagnostics."""

    CLOCK_JUMPED = "clock jumped"
    NO_POSE = "no pose"
    NEW_FIXED_FRAME = "new fixed frame"
    NO_SCAN = "no scan"
    SCAN_TOO_OLD = "scan too old"
    SCAN_WITHOUT_BEAMS = "scan without beams"
    SCAN_WITHOUT_RETURNS = "scan without returns"
    SCAN_NOT_LOCATED = "scan not located"
    SCAN_TOO_STEEP = "scan too steep"
    SCAN_IN_MILLIMETERS = "scan in millimeters"
    SCAN_IN_DEGREES = "scan in degrees"
    SCAN_THINNED = "scan thinned"
    NO_DEPTH = "no depth"
    DEPTH_TOO_OLD = "depth too old"
    DEPTH_NOT_LOCATED = "depth not located"
    DEPTH_UNREADABLE = "depth unreadable"
    LASER_MOUNTING_UNKNOWN = "laser mounting unknown"
    MAP_NOT_LOCATED = "map not located"
    CAMERA_INFO_REFUSED = "CameraInfo refused"
    PICTURE_SIZE_CHANGED = "picture size changed"
    INTRINSICS_SCALED = "intrinsics scaled"
    PRINCIPAL_POINT_OFF = "principal point off the middle"
    BIT_DEPTH_GUESSED = "bit depth guessed"
    HAND_BEYOND_LENS = "hand beyond the lens"
    CALLS_OF_LATER = "waiting list of a later time"

    @property
    def is_fault(self) -> bool:
        """Whether it means broken input, rather than an ordinary gap."""
        return self in _FAULTS

    @property
    def is_remark(self) -> bool:
        """Whether it is reported once, but is not a fault."""
        return self in _REMARKS

    @property
    def leaves_scan_unused(self) -> bool:
        """Whether it is a reason why no scan was used for an image."""
        return self in _WITHOUT_SCAN

    @property
    def leaves_depth_unused(self) -> bool:
        """Whether it is a reason why no depth image was used for an image."""
        return self in _WITHOUT_DEPTH


_FAULTS = frozenset(
    {
        NoteKind.CLOCK_JUMPED,
        NoteKind.SCAN_WITHOUT_BEAMS,
        NoteKind.CAMERA_INFO_REFUSED,
        NoteKind.DEPTH_UNREADABLE,
    }
)
_REMARKS = frozenset(
    {
        NoteKind.SCAN_IN_MILLIMETERS,
        NoteKind.SCAN_IN_DEGREES,
        NoteKind.SCAN_THINNED,
        NoteKind.LASER_MOUNTING_UNKNOWN,
        NoteKind.MAP_NOT_LOCATED,
        NoteKind.INTRINSICS_SCALED,
        NoteKind.PICTURE_SIZE_CHANGED,
        NoteKind.PRINCIPAL_POINT_OFF,
        NoteKind.BIT_DEPTH_GUESSED,
        NoteKind.HAND_BEYOND_LENS,
        NoteKind.CALLS_OF_LATER,
    }
)
_WITHOUT_SCAN = frozenset(
    {
        NoteKind.NO_SCAN,
        NoteKind.SCAN_TOO_OLD,
        NoteKind.SCAN_WITHOUT_BEAMS,
        NoteKind.SCAN_WITHOUT_RETURNS,
        NoteKind.SCAN_NOT_LOCATED,
        NoteKind.SCAN_TOO_STEEP,
    }
)
_WITHOUT_DEPTH = frozenset(
    {
        NoteKind.NO_DEPTH,
        NoteKind.DEPTH_TOO_OLD,
        NoteKind.DEPTH_NOT_LOCATED,
        NoteKind.DEPTH_UNREADABLE,
    }
)


@dataclass(frozen=True, slots=True)
class Note:
    """One thing that was missing or odd about an image.

    Attributes:
        kind: What it is about; code decides by the kind, never by the text.
        text: The same as a short sentence, with names and numbers.
    """

    kind: NoteKind
    text: str

    def __str__(self) -> str:
        return self.text
