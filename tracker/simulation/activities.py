"""What do people do with their hands when they do not call? Cycles of moments, each one painted.

Places are those of `arm.reach`: outward from the body's middle and up from the floor, of a person
who stands and is of ordinary stature, whose mouth is at 1.54 m and whose ears are at 1.60 m.
Movements and durations are guesses, drawn by eye.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True)
class Gesture:
    """What one hand does.

    Attributes:
        wrist_m: Outward and up.
        hand_deg: Direction of the fingers, from straight up outward.
        palm_visible: The palm faces the viewer.
        spread: Of the fingers.
        holds: `cup` or `phone`, `fist` for a closed hand, or None for an open one.
    """

    wrist_m: tuple[float, float]
    hand_deg: float
    palm_visible: bool = False
    spread: float = 0.4
    holds: str | None = None


@dataclass(frozen=True, slots=True)
class Moment:
    """One picture of a cycle.

    Attributes:
        duration_s: How long it is shown.
        hand: Of the hand that would be raised.
        other: Of the other one; None where that rests.
    """

    duration_s: float
    hand: Gesture
    other: Gesture | None = None


def _talk() -> tuple[Moment, ...]:
    """Both hands before the chest; now and then the fingers point up for a moment."""
    at = [
        ((0.16, 1.06), -70.0), ((0.24, 1.12), -60.0), ((0.30, 1.20), 22.0), ((0.34, 1.12), 55.0),
        ((0.20, 1.05), -80.0), ((0.26, 1.14), -65.0), ((0.32, 1.08), 75.0), ((0.26, 1.18), -25.0),
    ]  # fmt: skip
    gestures = [
        Gesture(place, angle, palm_visible=row % 3 != 0, spread=0.7)
        for row, (place, angle) in enumerate(at)
    ]
    other = [gestures[(row + 4) % len(gestures)] for row in range(len(gestures))]
    return tuple(Moment(0.35, *pair) for pair in zip(gestures, other, strict=True))


def _drink() -> tuple[Moment, ...]:
    cup = [((0.22, 1.06), -50.0), ((0.20, 1.22), -50.0), ((0.15, 1.42), -45.0),
           ((0.14, 1.45), -35.0)]  # fmt: skip
    up = [Gesture(place, angle, holds="cup") for place, angle in cup]
    return (Moment(3.0, up[0]), Moment(0.2, up[1]), Moment(0.8, up[2]), Moment(2.0, up[3]),
            Moment(0.4, up[2]), Moment(0.2, up[1]))  # fmt: skip


def _scratch() -> tuple[Moment, ...]:
    hand = [((0.17, 1.60), -50.0), ((0.15, 1.63), -62.0), ((0.16, 1.62), -42.0)]
    on_head = [Gesture(place, angle, spread=0.6) for place, angle in hand]
    rest = Gesture((0.22, 0.98), -95.0)
    return (Moment(2.0, rest), *(Moment(0.2, on_head[row % 3]) for row in range(10)))


ACTIVITIES: dict[str, tuple[Moment, ...]] = {
    "talk": _talk(),
    "drink": _drink(),
    "phone": (
        Moment(1.5, Gesture((0.155, 1.49), -8.0, holds="phone")),
        Moment(0.8, Gesture((0.160, 1.47), -3.0, holds="phone")),
    ),
    "scratch": _scratch(),
    "rest": (
        Moment(4.0, Gesture((0.14, 1.06), -88.0), Gesture((0.16, 1.05), -85.0)),
        Moment(2.0, Gesture((0.18, 1.06), -80.0), Gesture((0.12, 1.06), -92.0)),
    ),
    "chin": (
        Moment(2.5, Gesture((0.10, 1.40), -20.0, holds="fist")),
        Moment(1.0, Gesture((0.11, 1.38), -30.0, spread=0.2)),
        Moment(1.5, Gesture((0.13, 1.42), -12.0, spread=0.3)),
    ),
    "mouth": (
        Moment(1.5, Gesture((0.10, 1.45), -55.0, spread=0.1)),
        Moment(1.0, Gesture((0.12, 1.36), -25.0, palm_visible=True, spread=0.2)),
        Moment(2.0, Gesture((0.22, 1.05), -60.0)),
    ),
    "hair": (
        Moment(0.7, Gesture((0.16, 1.58), -35.0, spread=0.4)),
        Moment(0.7, Gesture((0.14, 1.66), -50.0, spread=0.4)),
        Moment(0.7, Gesture((0.17, 1.52), -20.0, spread=0.3)),
        Moment(2.0, Gesture((0.22, 1.00), -80.0)),
    ),
    "on_head": (Moment(3.0, *2 * (Gesture((0.17, 1.62), -40.0, spread=0.5),)),),
    "together": (
        Moment(2.0, *2 * (Gesture((0.05, 1.30), -8.0, spread=0.0),)),
        Moment(1.5, *2 * (Gesture((0.06, 1.24), -15.0, holds="fist"),)),
    ),
    "clap": tuple(
        Moment(0.15, *2 * (Gesture((apart, 1.25), -20.0, spread=0.2),))
        for apart in (0.05, 0.12, 0.18, 0.12)
    ),
    "cross": (Moment(4.0, *2 * (Gesture((-0.10, 1.22), -35.0, holds="fist"),)),),
    "thumb": (
        Moment(1.5, Gesture((0.24, 1.22), 10.0, holds="fist")),
        Moment(1.5, Gesture((0.20, 1.30), -20.0, holds="fist")),
    ),
    "aside": (
        Moment(1.5, Gesture((0.66, 1.36), 88.0, spread=0.2)),
        Moment(1.0, Gesture((0.60, 1.20), 70.0, spread=0.2)),
        Moment(1.0, Gesture((0.30, 1.05), 80.0)),
    ),
    "sign": (
        Moment(0.5, Gesture((0.20, 1.30), -10.0, palm_visible=True, spread=0.3)),
        Moment(0.5, Gesture((0.14, 1.34), -30.0, palm_visible=True, spread=0.8)),
        Moment(0.5, Gesture((0.24, 1.22), 5.0, holds="fist")),
        Moment(
            0.5, Gesture((0.10, 1.20), -60.0, spread=0.5), Gesture((0.14, 1.18), -50.0, spread=0.3)
        ),
    ),
    "wave_low": tuple(
        Moment(0.2, Gesture((0.40, 1.02), angle, palm_visible=True, spread=0.8))
        for angle in (70.0, 90.0, 110.0, 90.0)
    ),
}


def moment_at(what: str, time_s: float) -> int:
    """Which moment of an activity is shown, this long after it began."""
    ends = np.cumsum([moment.duration_s for moment in ACTIVITIES[what]])
    return int(np.searchsorted(ends, time_s % ends[-1], side="right")) % len(ends)
