"""What does a comparison with the truth say? Rows per raised hand, and their totals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class EpisodeRow:
    """One time that a person's hand was up and in view, and what became of it.

    Attributes:
        person: The person's number in the truth.
        start_ns: First truth sample with the hand up and in view.
        end_ns: Last one.
        xy_m: Where the person stood at the start.
        frames: Processed images in the episode.
        reported_ns: Stamp of the first image after which the person's track was raised, or None.
        reported_frames: How many images of the episode that took, itself included; or None.
        position_error_m: Median distance from the track to the person while reported, or None.
        identities: Ids of the tracks that reported it, in order.
    """

    person: int
    start_ns: int
    end_ns: int
    xy_m: tuple[float, float]
    frames: int
    reported_ns: int | None
    reported_frames: int | None
    position_error_m: float | None
    identities: tuple[int, ...]

    @property
    def delay_s(self) -> float | None:
        """From the hand being up to its report, or None."""
        return None if self.reported_ns is None else (self.reported_ns - self.start_ns) / 1e9


@dataclass(frozen=True, slots=True)
class InventedRow:
    """One time that a track was raised without a raised hand behind it.

    Attributes:
        identity: The track's id.
        start_ns: First image in which it was unfounded.
        end_ns: Last one.
        xy_m: Where the track stood at first.
        person: Whose place it was (their hand was down), or None where nobody was near.
    """

    identity: int
    start_ns: int
    end_ns: int
    xy_m: tuple[float, float]
    person: int | None


@dataclass(frozen=True, slots=True)
class EpisodeReport:
    """What the evaluation found.

    Attributes:
        start_ns: Second 0 of the tables.
        episodes: In order of their start.
        invented: In order of their start.
        too_short: Episodes with fewer images than a streak needs; they are in neither list.
        identities: Per person, the tracks that reported their hand, in order.
        identity_switches: How often a person's hand was reported as another track than before.
        position_error_m: Median over all images and people with a reported hand, or None.
        frames: Processed images compared with the truth.
        frames_without_truth: Processed images that had no truth sample near in time.
    """

    start_ns: int
    episodes: tuple[EpisodeRow, ...]
    invented: tuple[InventedRow, ...]
    too_short: int
    identities: dict[int, tuple[int, ...]]
    identity_switches: int
    position_error_m: float | None
    frames: int
    frames_without_truth: int

    @property
    def missed(self) -> tuple[EpisodeRow, ...]:
        """Episodes that nothing reported."""
        return tuple(row for row in self.episodes if row.reported_ns is None)

    @property
    def found(self) -> tuple[EpisodeRow, ...]:
        """Episodes that were reported."""
        return tuple(row for row in self.episodes if row.reported_ns is not None)

    def seconds(self, stamp_ns: int) -> float:
        """A stamp as seconds since the start."""
        return (stamp_ns - self.start_ns) / 1e9

    def as_dict(self) -> dict[str, Any]:
        """The same in plain numbers, lists and None, fit for JSON."""
        return {
            "episodes": [
                {
                    "person": row.person,
                    "hand_up_at_s": round(self.seconds(row.start_ns), 6),
                    "hand_down_at_s": round(self.seconds(row.end_ns), 6),
                    "xy_m": list(row.xy_m),
                    "frames": row.frames,
                    "reported_after_s": row.delay_s,
                    "reported_after_frames": row.reported_frames,
                    "position_error_m": row.position_error_m,
                    "identities": list(row.identities),
                }
                for row in self.episodes
            ],
            "invented": [
                {
                    "identity": row.identity,
                    "from_s": round(self.seconds(row.start_ns), 6),
                    "to_s": round(self.seconds(row.end_ns), 6),
                    "xy_m": list(row.xy_m),
                    "person": row.person,
                }
                for row in self.invented
            ],
            "found": len(self.found),
            "missed": len(self.missed),
            "too_short": self.too_short,
            "identities": {str(key): list(value) for key, value in self.identities.items()},
            "identity_switches": self.identity_switches,
            "position_error_m": self.position_error_m,
            "frames": self.frames,
            "frames_without_truth": self.frames_without_truth,
        }
