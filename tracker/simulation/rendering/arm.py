"""Where does an arm run? Its joints while a hand goes up, and for a hand that is somewhere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.containers import FloatArray
from tracker.simulation.rendering.hand_shape import hand_landmarks
from tracker.simulation.rendering.look import Look

#: Upper arm, forearm and hand of an arm that is up; degrees from down, outward.
_RAISED_DEG = {
    "beside": (78.0, 192.0, 178.0),
    "straight": (165.0, 176.0, 178.0),
    "low": (14.0, 184.0, 178.0),
}
#: How high the fingers reach, of a figure of ordinary stature.
_REACH_M = {"beside": 1.85, "straight": 2.12, "low": 1.85}
_UPPER_ARM_M, _FOREARM_M = 0.27, 0.24
#: How far the forearm of somebody who waves swings to either side, degrees (guess).
_WAVE_DEG = 25.0


@dataclass(frozen=True, slots=True)
class Arm:
    """Where a figure's arm runs, on its sheet.

    Attributes:
        shoulder_m: x and z.
        elbow_m: x and z.
        wrist_m: x and z.
        hand_rad: Direction of the fingers, from straight up toward the right.
    """

    shoulder_m: tuple[float, float]
    elbow_m: tuple[float, float]
    wrist_m: tuple[float, float]
    hand_rad: float


def bend_arm(look: Look, raised: float, side: float, swing: float = 0.0) -> Arm:
    """The joints of an arm on its way up.

    Args:
        look: Whose arm.
        raised: 0 hangs (or rests on the lap), 1 is up in the person's style.
        side: -1 for the arm at the sheet's left, 1 for the one at its right.
        swing: Of somebody who waves: -1 is farthest inward, 1 farthest outward.
    """
    low = (8.0, 2.0, 0.0) if look.seat_m is None else (12.0, -42.0, -60.0)
    *arm, straight_hand = _RAISED_DEG[look.raise_style]
    high = (*arm, straight_hand - look.lean_deg)
    upper, fore, hand = (np.radians(a + (b - a) * raised) for a, b in zip(low, high, strict=True))
    fore, hand = fore - np.radians(_WAVE_DEG * swing), hand - np.radians(_WAVE_DEG * swing)
    scale = look.scale
    x, z = _shoulder(look)
    elbow_x = x + _UPPER_ARM_M * scale * np.sin(upper)
    elbow_z = z - _UPPER_ARM_M * scale * np.cos(upper)
    wrist_x = elbow_x + _FOREARM_M * scale * np.sin(fore)
    wrist_z = elbow_z - _FOREARM_M * scale * np.cos(fore)
    return Arm(
        (side * x, z),
        (side * float(elbow_x), float(elbow_z)),
        (side * float(wrist_x), float(wrist_z)),
        float(side * (np.pi - hand)),
    )


def reach(look: Look, place_m: tuple[float, float], hand_deg: float, side: float) -> Arm:
    """The joints of an arm whose wrist is at a place in front of the body.

    The upper arm hangs where the forearm is long enough for that; else the forearm comes from
    below, or the arm is stretched. Whichever bone is drawn too short points toward the viewer.

    Args:
        look: Whose arm.
        place_m: The wrist, outward from the middle and up from the floor, as if the person stood
            and were of ordinary stature.
        hand_deg: Direction of the fingers, from straight up outward.
        side: As for `bend_arm`.
    """
    scale = look.scale
    shoulder = np.array(_shoulder(look))
    wrist = np.array([place_m[0] * scale, place_m[1] * scale - look.sunk_m])
    elbow = shoulder + _UPPER_ARM_M * scale * np.array([0.15, -0.988])
    if np.linalg.norm(wrist - elbow) > _FOREARM_M * scale:
        elbow = wrist + _FOREARM_M * scale * np.array([0.43, -0.902])
    if np.linalg.norm(shoulder - elbow) > _UPPER_ARM_M * scale:
        elbow = shoulder + _UPPER_ARM_M / (_UPPER_ARM_M + _FOREARM_M) * (wrist - shoulder)
    return Arm(
        (side * float(shoulder[0]), float(shoulder[1])),
        (side * float(elbow[0]), float(elbow[1])),
        (side * float(wrist[0]), float(wrist[1])),
        float(side * np.radians(hand_deg)),
    )


def raised_hand_landmarks(
    look: Look, *, from_behind: bool = False, swing: float = 0.0
) -> FloatArray:
    """Landmarks of the open hand that is fully up, shape (21, 2): x_m and z_m on the sheet."""
    side = raising_side(look, from_behind=from_behind)
    arm = bend_arm(look, 1.0, side, swing)
    return hand_landmarks(
        arm.wrist_m,
        arm.hand_rad,
        thumb_right=side < 0,
        length_m=look.hand_m,
        spread=look.spread,
    )


def raising_side(look: Look, *, from_behind: bool) -> float:
    """Where on the sheet the arm is that goes up: -1 at its left, 1 at its right."""
    return -1.0 if look.right_handed != from_behind else 1.0


def top_m(look: Look) -> float:
    """Height that the figure with its arm up does not exceed."""
    return max(look.stature_m, _REACH_M[look.raise_style] * look.scale) - look.sunk_m


def _shoulder(look: Look) -> tuple[float, float]:
    return 0.175 * look.scale, 1.385 * look.scale - look.sunk_m
