"""What stays with a person, whatever the hands do? Build, colors, clothes, the way to call."""

from __future__ import annotations

from dataclasses import dataclass

from tracker.simulation.rendering.canvas import Color
from tracker.simulation.rendering.hand_shape import HAND_LENGTH_M

STATURE_M = 1.72  # of the figure that the lengths of `figure` draw; a guess at a grown person
HIP_M = 0.90


@dataclass(frozen=True, slots=True)
class Look:
    """What stays with a person.

    Attributes:
        stature_m: Height when standing.
        seat_m: Height of the seat; None for somebody who stands.
        right_handed: Raises the right hand.
        skin: Blue, green, red.
        hair: Blue, green, red.
        hair_style: `short`, `long`, `bun` or `bald`.
        shirt: Blue, green, red.
        trousers: Blue, green, red.
        sleeve: `short`, `long` or `bare`.
        build: How wide trunk and limbs are; 1 is ordinary.
        hand_m: From the wrist to the middle finger's tip.
        spread: Of the fingers: 1 is wide apart, 0 is closed.
        raise_style: `beside` the head, `straight` up, or `low`, with the elbow at the side.
        lean_deg: How far the raised hand leans outward.
        has_stool: Who sits is drawn on a stool.
        sign: What the raised hand shows: `palm`, `fist` or `finger`.
    """

    stature_m: float = STATURE_M
    seat_m: float | None = None
    right_handed: bool = True
    skin: Color = (120, 160, 214)
    hair: Color = (40, 52, 74)
    hair_style: str = "short"
    shirt: Color = (150, 110, 60)
    trousers: Color = (80, 64, 56)
    sleeve: str = "short"
    build: float = 1.0
    hand_m: float = HAND_LENGTH_M
    spread: float = 1.0
    raise_style: str = "beside"
    lean_deg: float = 0.0
    has_stool: bool = True
    sign: str = "palm"

    @property
    def scale(self) -> float:
        """Of every length but the hand's, which has its own."""
        return self.stature_m / STATURE_M

    @property
    def sunk_m(self) -> float:
        """How much lower the trunk is than when standing."""
        return 0.0 if self.seat_m is None else self.scale * HIP_M - self.seat_m - 0.06
